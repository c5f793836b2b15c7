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

/// What a contact may add to λmax(S_i) of a grain at weight 1 as it moves [1/s²].
struct Play {
  double turn = 0;  ///< for every unit by which its direction is off, |n − n₀|
  double arm = 0;   ///< as its arm follows the overlap, in all
};

/// `reach`: the overlap allowed [m]. Of S_i, the block of translations changes by at most |kn − kt| |n − n₀|, that of
/// rotations by kt a² as much, those beside by kt a as much. An arm changes by no more than half of the overlap.
inline Play play(double kn, double kt, double reach, const Inertia& g) {
  const double shift = std::abs(kn - kt) * g.inverse_mass, turn = kt * g.radius * g.radius * g.inverse_inertia,
               mixed = kt * g.radius * std::sqrt(g.inverse_mass * g.inverse_inertia);
  const double norm = 0.5 * (shift + turn) + std::sqrt(0.25 * (shift - turn) * (shift - turn) + mixed * mixed);
  return {norm * sum_rounding, (0.5 * mixed + turn) * std::max(0.0, reach) / g.radius * sum_rounding};
}
/// The same of a spring of couples.
inline Play play_of_couple(double twisting, double rolling, const Inertia& g) {
  return {std::abs(twisting - rolling) * g.inverse_inertia * sum_rounding, 0};
}

/// Whether a spring is counted.
inline bool acts(const Spring& s) { return s.normal > 0 || s.tangential > 0; }

/// How a spring that is counted may move.
struct SpringMotion {
  double reach = 0;    ///< overlap that it is allowed [m]
  double turned = 0;   ///< |n − n₀|, n₀ the direction that it was counted with
  double turning = 0;  ///< how much n may change until the next check
};

/// The sums over the contacts of a grain, at their weights [1/s²].
struct GrainPlay {
  double turn = 0;     ///< for every unit by which all directions are off
  double counted = 0;  ///< to be added to λmax(S_i) of the present directions for a bound about those counted
  double ahead = 0;    ///< … for one that holds until the next check
};
/// What λmax(S_i) of the present directions must stay below for a bound to hold until the next check.
inline double most_below(double bound, const GrainPlay& play) { return bound - std::max(play.counted, play.ahead); }
/// Sets what is known of a grain, `high` ≥ λmax(S_i) of the present directions.
inline void keep_grain(StandingBound& bound, std::size_t grain, double high, const GrainPlay& play) {
  bound.grain[grain] = std::min(high + play.counted, bound.value);
  bound.turning[grain] = play.turn;
}
/// `met`: of every spring.
std::vector<GrainPlay> plays_of(const Sides& sides, const std::vector<double>& t, std::span<const SpringMotion> met);

}  // namespace eg
