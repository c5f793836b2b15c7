#pragma once
// Which pairs may meet, and in what order the loops take them.
#include <cstdint>
#include <vector>

#include "base/vec.hpp"

namespace eg {

/// Pairs within reach of each other, found rarely from a grid; contacts are picked from it often. Part of the state, so
/// that a resumed run goes on with the same lists bit for bit.
struct NeighbourList {
  std::vector<std::uint64_t> begin;  ///< row of grain i: [begin[i], begin[i+1])
  std::vector<Index> j;              ///< ascending in a row; j ≥ i
  std::vector<std::uint8_t> image;   ///< code of Cell::shift; empty when no direction is periodic

  double skin = 0;              ///< pairs with gap < skin are listed when the list is made [m]
  double contact_skin = 0;      ///< likewise for State::contacts [m]
  double longest = 0;           ///< largest diameter plus skin [m]
  double used = 0;              ///< skin used up before State::contacts was last refreshed [m]
  double grown = 0;             ///< by which surfaces have come nearer since then as radii grew, at most [m]
  std::vector<Vec3> reference;  ///< positions when State::contacts was last refreshed [m]
  Mat3 reference_cell;          ///< cell matrix then
  std::uint64_t builds = 0, refreshes = 0;
  std::uint64_t refreshed = 0;  ///< step of the last refresh
};

}  // namespace eg
