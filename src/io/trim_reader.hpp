#pragma once
#include "io/toml_reader.hpp"
#include "state/scene.hpp"

namespace eg {

/// specimen.trim of a scene. Throws InputError.
TrimSpec read_trim(const TomlReader& table, int dimension);

}  // namespace eg
