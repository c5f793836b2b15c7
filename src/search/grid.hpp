#pragma once
// A hierarchy of uniform grids, one a size class (radii within a factor of two), so that the cost stays O(N) at any
// size ratio. Pairs of unequal class are found from the smaller grain's side.
#include <vector>

#include "state/state.hpp"

namespace eg {

/// A pair of grains whose surfaces are closer than the skin: branch = x_j + shift(image) − x_i, i ≤ j.
struct NearPair {
  Index i, j;
  std::uint8_t image;
};

/// All pairs with gap < skin. Positions must lie in the cell along periodic directions. Deterministic order for any
/// number of threads. Throws RunError when the cell is narrower than the largest diameter plus skin along a periodic
/// direction.
std::vector<NearPair> find_pairs(const Grains& grains, const Cell& cell, double skin);

}  // namespace eg
