#pragma once
#include "specimen/lattice.hpp"
#include "state/packing.hpp"
#include "state/scene.hpp"

namespace eg {

/// The lattice or cloud that [specimen] of a scene asks for; periodic when its boundary is. The same for the same seed.
/// Throws InputError when the scene contradicts itself or its pressure cannot be reached, RunError when a cloud cannot
/// be made (specimen/cloud.hpp). A scene of source "file" has no packing of its own: read it, see io/packing_file.hpp.
Packing make_packing(const Scene&);

/// The scene's contact law between two grains of its first material.
NormalForce normal_force(const Scene&);

}  // namespace eg
