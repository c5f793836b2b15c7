#pragma once
#include "state/packing.hpp"
#include "state/scene.hpp"

namespace eg {

/// The grains of a packing that scene.specimen.trim keeps, in a box of their own that is not periodic: the lower corner
/// of what they were trimmed to lies at 0, sides that were not cut lie at the outermost grains, cuts beyond the
/// packing's box at its sides. Throws InputError when no grain is left. Needs scene.specimen.trim.
Packing trimmed(const Scene& scene, const Packing& packing);

}  // namespace eg
