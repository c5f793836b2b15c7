#pragma once
// Contacts of bodies that answer forces.
#include <cstdint>
#include <vector>

#include "state/state.hpp"

namespace eg {

/// A body of mass m ≥ ¾ K Δt², or a servo that takes no more than ⅔ of the way at once, adds no more to λmax than half
/// the stiffness of its contacts again (docs/walls.md).
inline constexpr double yielding = 1.5;

/// Whether a grain is glued to such a body, one a grain; empty when none is.
inline std::vector<std::uint8_t> glued_that_yield(const State& state) {
  std::vector<std::uint8_t> yields;
  for (const auto& g : state.glued) {
    if (!state.bodies[g.body].yields) continue;
    yields.resize(state.grains.size(), 0);
    yields[g.grain] = 1;
  }
  return yields;
}

}  // namespace eg
