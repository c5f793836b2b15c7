#pragma once
// Grains as bare geometry, before a scene gives them mass: what a lattice, a cloud or a packing file yields.
#include <array>
#include <vector>

#include "base/vec.hpp"

namespace eg {

struct Packing {
  Vec3 box{1, 1, 1};           ///< edges [m], lower corner at 0; 2D: box.z = 1
  std::vector<Vec3> position;  ///< centres [m]; 2D: z = 0
  std::vector<double> radius;  ///< [m]
  int dimension = 3;
  std::array<bool, 3> periodic{false, false, false};  ///< 2D: never along z

  std::size_t size() const { return position.size(); }
};

}  // namespace eg
