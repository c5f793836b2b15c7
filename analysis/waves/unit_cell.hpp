#pragma once
// The smallest cell that a periodic packing repeats. A perfect lattice comes as a block of conventional cells; its
// waves are those of one primitive cell, without the folded branches that the block would show.
#include <span>
#include <vector>

#include "assembly/network.hpp"

namespace eg {

struct UnitCell {
  Network network;             ///< of one cell; springs reach into its images, branch = n · length
  std::vector<Vec3> position;  ///< of its grains [m]
  Mat3 edges;                  ///< columns: translations that repeat it [m]; 2D: the third is the unit vector z
  std::size_t copies = 1;      ///< how often the packing holds it
};

/// Grains of `network` at `position`, repeated by the columns of `edges` (2D: third column along z). Looks for the
/// shortest translations that leave masses, radii and springs as they are (to 1e-7 of their size); a packing without
/// any is its own unit cell. O(N log N) for a packing without symmetry. Needs a network without walls.
UnitCell find_unit_cell(const Network& network, std::span<const Vec3> position, const Mat3& edges);

}  // namespace eg
