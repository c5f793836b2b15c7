#pragma once
#include "base/number.hpp"

namespace eg {

/// A stiffness of the damped network (damping.hpp) over any number type: (1 + α)(k + 2c/Δt), c = 2ξ√(m* k) [N/m].
/// `ratio`: ξ of its dashpot, 0 for none.
template <class S>
S damped_stiffness(const S& stiffness, const S& inverse_mass, double ratio, double local, double step) {
  if (!(ratio > 0)) return S(1 + local) * stiffness;
  const S mass = select(inverse_mass > S(0.0), reciprocal(max(inverse_mass, S(1e-300))), S(0.0));
  return S(1 + local) * (stiffness + S(4 * ratio / step) * root(mass * stiffness));
}

}  // namespace eg
