#pragma once
// [boundary] of a scene file: walls, meshes, rings and the bodies they belong to. Private to the scene reader.
#include "io/toml_reader.hpp"
#include "state/scene.hpp"

namespace eg {

std::vector<std::string> material_names(const Scene& scene);

/// Reads scene.boundary. Of the scene dimension and materials are looked at: they must be read before.
void read_boundary(const TomlReader&, Scene&);

/// [stage.body.NAME] and glue; scene.boundary must be read before.
void read_bodies(const TomlReader& stage, const Scene&, StageSpec&);

}  // namespace eg
