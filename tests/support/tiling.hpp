#pragma once
// Large packings from small ones: copies side by side.
#include "specimen/make_state.hpp"
#include "state/state.hpp"

namespace eg::test {

/// copies³ copies of a periodic packing (orthogonal cell, 3D) in one cell: the same moduli, stress and fabric.
inline State tiled(const Scene& scene, const State& state, int copies) {
  Packing packing;
  packing.periodic = state.cell.periodic;
  const Vec3 edge{state.cell.h(0, 0), state.cell.h(1, 1), state.cell.h(2, 2)};
  packing.box = edge * static_cast<double>(copies);
  for (int x = 0; x < copies; ++x)
    for (int y = 0; y < copies; ++y)
      for (int z = 0; z < copies; ++z)
        for (std::size_t g = 0; g < state.grains.size(); ++g) {
          packing.position.push_back(state.grains.position[g].vec() + Vec3{x * edge.x, y * edge.y, z * edge.z});
          packing.radius.push_back(state.grains.radius(g));
        }
  return make_state(scene, packing);
}

}  // namespace eg::test
