#pragma once
#include <numbers>

namespace eg {

/// 3D: sphere, m = ρ 4/3 π R³, I = 2/5 m R². 2D: disk of unit thickness, m = ρ π R², I = 1/2 m R².
struct GrainMass {
  double mass, inertia;  ///< [kg], [kg m²] (2D: per metre of thickness)
};
inline GrainMass grain_mass(int dimension, double density, double radius) {
  const double square = radius * radius;
  const double mass = density * std::numbers::pi * square * (dimension == 3 ? 4 * radius / 3 : 1.0);
  return {mass, (dimension == 3 ? 0.4 : 0.5) * mass * square};
}

}  // namespace eg
