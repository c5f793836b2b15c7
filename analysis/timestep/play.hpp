#pragma once
// How much S_i of contact splitting may change while a contact turns and its arms follow the overlap (certificates.md).
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "state/state.hpp"
#include "timestep/sides.hpp"

namespace eg {

inline constexpr double sum_rounding = 1 + 1e-11;  ///< of sums of a few dozen positive numbers

/// A grain that a spring acts on.
struct Inertia {
  double inverse_mass, inverse_inertia, radius;
};
inline Inertia inertia_of(const Network& net, Index g) {
  return {net.inverse_mass[g], net.rotation ? net.inverse_inertia[g] : 0.0, net.radius[g]};
}
inline Inertia inertia_of(const Grains& g, Index i) {
  return {g.velocity[i].w, g.rotates() ? g.spin[i].w : 0.0, g.radius(i)};
}

/// The largest that a spring can add to λmax(S_i) of a grain at weight 1 (arm ≤ R) [1/s²].
inline double most_added(double kn, double kt, const Inertia& g) {
  return std::max(kn * g.inverse_mass, kt * (g.inverse_mass + g.inverse_inertia * g.radius * g.radius));
}

/// How a spring that is counted may move until the next check.
struct SpringMotion {
  double reach = 0;    ///< overlap that it is allowed [m]
  double turning = 0;  ///< how much n may change, |n − n₀| [-]
};

/// What a contact may add to λmax(S_i) of a grain at weight 1 as it moves [1/s²]. Of S_i, the block of translations
/// changes by at most |kn − kt| |n − n₀|, that of rotations by kt a² as much, those beside by kt a as much. An arm
/// changes by no more than half of the overlap.
inline double play(double kn, double kt, const SpringMotion& m, const Inertia& g) {
  const double shift = std::abs(kn - kt) * g.inverse_mass, turn = kt * g.radius * g.radius * g.inverse_inertia,
               mixed = kt * g.radius * std::sqrt(g.inverse_mass * g.inverse_inertia);
  const double norm = 0.5 * (shift + turn) + std::sqrt(0.25 * (shift - turn) * (shift - turn) + mixed * mixed);
  const double arm = (0.5 * mixed + turn) * std::max(0.0, m.reach) / g.radius;
  return (norm * m.turning + arm) * sum_rounding;
}
/// The same of a spring of couples.
inline double play_of_couple(double twisting, double rolling, const SpringMotion& m, const Inertia& g) {
  return std::abs(twisting - rolling) * g.inverse_inertia * m.turning * sum_rounding;
}

/// Whether a spring is counted.
inline bool acts(const Spring& s) { return s.normal > 0 || s.tangential > 0; }

/// For every grain the sum over its contacts at their weights [1/s²]. `met`: of every spring.
std::vector<double> plays_of(const Sides& sides, const std::vector<double>& t, std::span<const SpringMotion> met);

}  // namespace eg
