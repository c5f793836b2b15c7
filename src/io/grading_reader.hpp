#pragma once
// Sizes of grains in [specimen] of a scene file. Private to the scene reader.
#include "io/toml_reader.hpp"
#include "state/scene.hpp"

namespace eg {

/// specimen.grading: the name of a preset or a table; gap gradings become tables of passing.
Grading read_grading(const TomlReader& specimen);

}  // namespace eg
