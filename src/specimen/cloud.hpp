#pragma once
// Random clouds: grains of given radii strewn over a box so that no two overlap.
#include <array>
#include <span>

#include "base/random.hpp"
#include "state/packing.hpp"

namespace eg {

struct CloudSpec {
  int dimension = 3;
  double solid_fraction = 0.3;            ///< volume of grains over volume of the box [-]
  std::array<double, 3> aspect{1, 1, 1};  ///< edges of the box relative to each other; aspect[2] is not read in 2D
  bool periodic = true;                   ///< false: grains lie wholly inside the box
  Vec3 box{};                             ///< edges of the box [m], instead of fraction and aspect where they are > 0
};

/// Grain i has radii[i] [m]. Random sequential insertion, the largest grains first; when the box is too full for that
/// (equal spheres: from about .36), the rest are put anywhere and overlaps are pushed apart until none is left.
/// Good to solid fractions about .55 (3D) and .75 (2D). Throws RunError when that fails or a grain does not fit the
/// box.
Packing make_cloud(std::span<const double> radii, const CloudSpec&, Random&);

}  // namespace eg
