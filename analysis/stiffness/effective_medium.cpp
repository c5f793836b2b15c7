#include "stiffness/effective_medium.hpp"

#include <cmath>
#include <numbers>

namespace eg {
namespace {

constexpr double pi = std::numbers::pi;

/// Contact radius under the mean force N = 4πR²p/(Zφ): a³ = 3(1 − ν)NR/(8G), bonded over b beforehand:
/// (a² − b²)^½ (a² + b²/2) = the same (Digby 1981).
double contact_radius(const MeanPacking& m, double g, double nu, double p, double b) {
  const double cube = 3 * pi * (1 - nu) * p * std::pow(m.radius, 3) / (2 * m.coordination * m.solid_fraction * g);
  double d = std::cbrt(cube);  // d = √(a² − b²), d³ + 3/2 b² d = cube
  for (int k = 0; k < 60; ++k) d -= (d * d * d + 1.5 * b * b * d - cube) / (3 * d * d + 1.5 * b * b);
  return std::sqrt(d * d + b * b);
}

}  // namespace

BulkShear mean_field(const MeanPacking& m, double kn, double kt) {
  const double density = m.coordination * m.solid_fraction / (pi * m.radius);
  return {density * kn / 6, density * (kn + 1.5 * kt) / 10};
}

BulkShear walton_rough(const MeanPacking& m, double g, double nu, double p) {
  const double a = contact_radius(m, g, nu, p, 0);
  return mean_field(m, 2 * g * a / (1 - nu), 4 * g * a / (2 - nu));
}

BulkShear walton_smooth(const MeanPacking& m, double g, double nu, double p) { return digby(m, g, nu, p, 0); }

BulkShear digby(const MeanPacking& m, double g, double nu, double p, double b) {
  return mean_field(m, 2 * g * contact_radius(m, g, nu, p, b) / (1 - nu), 4 * g * b / (2 - nu));
}

}  // namespace eg
