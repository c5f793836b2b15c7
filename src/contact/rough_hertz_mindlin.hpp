#pragma once
// Hertz–Mindlin contacts of rough spheres in three stages (Otsubo, O'Sullivan, Hanley and Sim 2017): asperities alone,
// then asperities and bulk, then the bulk with the asperities pressed flat.
#include <cmath>

#include "base/power.hpp"
#include "contact/hertz_mindlin.hpp"

namespace eg {

/// Numbers of the law. δ1 and δ2 in units of s are the authors'; the others follow from N being continuous with its
/// derivative at both thresholds and N_T2 = 100 N_T1.
namespace rough {
inline constexpr double first = 0.82, second = 1.24;  ///< δ1/s, δ2/s
inline constexpr double ratio = 100;                  ///< N_T2/N_T1
inline constexpr double b = 1.583009685810189, c = 2.589795495330664;
inline constexpr double end1 = 2.109318870100697, end2 = 24.46702373278582;  ///< δ_T1/s, δ_T2/s
}  // namespace rough

/// s = √(Sq1² + Sq2²), √2 Sq of equal surfaces; N_T1 = s E* √(2R* s).
/// δ ≤ δ_T1: N = N_T1 (δ/δ_T1)^c; δ ≤ δ_T2: N = 100 N_T1 [(δ − δ1)/(δ_T2 − δ1)]^b; above: N = (4/3)E*√R*
/// (δ − δ1 − δ2)^1.5. kn = dN/dδ, kt = [2(1 − ν)/(2 − ν)] kn; T += kt Δs, |T| ≤ µN. Sq = 0 is the smooth law.
struct RoughHertzMindlin {
  static constexpr std::string_view name = "rough-hertz-mindlin";
  static constexpr std::string_view partial_slip_name = "rough-hertz-mindlin-deresiewicz";
  static constexpr std::size_t history_vectors = 1, history_scalars = 0;

  static std::vector<ConstantSet> constant_sets() {
    return {{{"shear_modulus", &Material::shear_modulus},
             {"poisson", &Material::poisson},
             {"roughness", &Material::roughness}}};
  }

  template <class S>
  struct Constants {
    S e_star, ratio, s, friction;  ///< E* [Pa], kt/kn, s [m], µ
    S inverse_s, asperities;       ///< 1/s, √2 s^1.5 [m^1.5]
  };
  template <class S>
  struct Pair {
    S hertz;       ///< (4/3) E* √R* [N/m^1.5]
    S asperities;  ///< N_T1 [N]
    S ratio, s, friction, inverse_s;
  };

  static Constants<double> constants(const Material& a, const Material& b, int dimension) {
    const auto smooth = HertzMindlin::constants(a, b, dimension);
    const double s = std::max(std::hypot(a.roughness, b.roughness), 1e-20);
    return {smooth.e_star, 4 * smooth.g_star / smooth.e_star, s, smooth.friction, 1 / s, std::sqrt(2 * s) * s};
  }

  template <class S>
  EG_INLINE static Pair<S> pair(const Constants<S>& c, const Sizes<S>& sizes) {
    const S stiff = c.e_star * root_of_ratio(sizes.product, sizes.length);
    return {S(4.0 / 3.0) * stiff, stiff * c.asperities, c.ratio, c.s, c.friction, c.inverse_s};
  }

  /// N = scale · x^exponent with x = (δ − shift) · per_length of the stage that δ lies in.
  template <class S>
  struct Stage {
    S scale, exponent, shift, per_length;
  };
  template <class S>
  EG_INLINE static Stage<S> stage(const Pair<S>& p, const S& overlap) {
    using namespace rough;
    const auto beyond1 = overlap > S(end1) * p.s, beyond2 = overlap > S(end2) * p.s;
    const auto pick = [&](const S& asperities, const S& both, const S& bulk) {
      return select(beyond2, bulk, select(beyond1, both, asperities));
    };
    return {pick(p.asperities, S(rough::ratio) * p.asperities, p.hertz), pick(S(c), S(b), S(1.5)),
            pick(S(0.0), S(first) * p.s, S(first + second) * p.s),
            pick(S(1 / end1) * p.inverse_s, S(1 / (end2 - first)) * p.inverse_s, S(1.0))};
  }

  template <class S>
  EG_INLINE static NormalResponse<S> normal(const Pair<S>& p, const S& overlap) {
    const Stage<S> at = stage(p, overlap);
    const S beyond = max(overlap - at.shift, S(1e-30));
    const S slope = at.scale * at.per_length * power(beyond * at.per_length, at.exponent - S(1.0));  // N/(δ − shift)
    const S touching = select(overlap > S(0.0), slope, S(0.0));
    const S kn = at.exponent * touching;
    return {touching * beyond, kn, p.ratio * kn};
  }

  static double normal_energy(const Pair<double>& p, double overlap) {
    using namespace rough;
    const auto within = [&](double depth) {  // ∫N dδ from where the stage's own x is 0
      const Stage<double> at = stage(p, depth);
      return normal<double>(p, depth).force * (depth - at.shift) / (at.exponent + 1);
    };
    // A threshold belongs to the stage below it; its upper neighbour starts from the same force.
    const double t1 = end1 * p.s, t2 = end2 * p.s, n1 = p.asperities, n2 = rough::ratio * p.asperities;
    double energy = within(overlap);
    if (overlap > t1) energy += n1 * (t1 / (c + 1) - (t1 - first * p.s) / (b + 1));
    if (overlap > t2) energy += n2 * ((t2 - first * p.s) / (b + 1) - (t2 - (first + second) * p.s) / 2.5);
    return energy;
  }

  template <class S>
  EG_INLINE static Response<S> respond(const Pair<S>& p, const Strain<S>& strain, std::array<S, 3>& h) {
    return cumulative_shear(normal<S>(p, strain.overlap), p.friction, strain.slip, h);
  }
};
static_assert(ContactLaw<RoughHertzMindlin>);

}  // namespace eg
