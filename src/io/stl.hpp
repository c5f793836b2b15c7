#pragma once
// Triangle meshes from STL files, ASCII and binary.
#include "state/scene.hpp"

namespace eg {

/// Fills mesh.facets from its file (relative to `folder`), scaled and shifted, corners that coincide within 1e-6 of the
/// mesh's size made equal. Throws InputError, with the number of the facet, for a file that is no STL or is cut short,
/// a facet without area, an edge that three facets share, facets that turn the other way round than a neighbour, and
/// (but for mesh.open) an edge with one facet only.
void read_mesh_file(MeshSpec& mesh, const std::string& folder);

}  // namespace eg
