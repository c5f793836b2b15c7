#pragma once
// [[stage]] of a scene file. Private to the scene reader.
#include "io/toml_reader.hpp"
#include "state/scene.hpp"

namespace eg {

/// Reads one stage. Of the scene dimension, contact, specimen, boundary and record are looked at: they must be read
/// before.
StageSpec read_stage(const TomlReader&, const Scene&);

}  // namespace eg
