#pragma once
// Hertz–Mindlin with a free exponent, as PFC has it (Itasca 2008; Potyondy and Cundall's "hertz" model).
#include "base/power.hpp"
#include "contact/hertz_mindlin.hpp"

namespace eg {

/// N = h δ^α with h = 2 G √(2R̄)/(3(1 − ν)) = (4/3) E* √R*, R̄ = 2 R1 R2/(R1 + R2); kn = α h δ^(α−1);
/// ks = [2(1 − ν)/(2 − ν)] α h^(1/α) N^((α−1)/α) = [2(1 − ν)/(2 − ν)] kn; T += ks Δs, |T| ≤ µN. α = 1.5 is
/// Hertz–Mindlin. h keeps its value, so that other exponents take their unit from 1 m; two materials: the mean α.
struct HertzExponent {
  static constexpr std::string_view name = "hertz-mindlin-exponent";
  static constexpr std::size_t history_vectors = 1, history_scalars = 0;

  static std::vector<ConstantSet> constant_sets() {
    return {{{"shear_modulus", &Material::shear_modulus},
             {"poisson", &Material::poisson},
             {"hertz_exponent", &Material::hertz_exponent}}};
  }

  template <class S>
  struct Constants {
    S e_star, ratio, exponent, friction;  ///< E* [Pa], ks/kn, α, µ
  };
  template <class S>
  struct Pair {
    S h, ratio, exponent, friction;  ///< h [N/m^α]
  };

  static Constants<double> constants(const Material& a, const Material& b, int dimension) {
    const auto smooth = HertzMindlin::constants(a, b, dimension);
    return {smooth.e_star, 4 * smooth.g_star / smooth.e_star, (a.hertz_exponent + b.hertz_exponent) / 2,
            smooth.friction};
  }

  template <class S>
  EG_INLINE static Pair<S> pair(const Constants<S>& c, const Sizes<S>& sizes) {
    return {S(4.0 / 3.0) * c.e_star * root_of_ratio(sizes.product, sizes.length), c.ratio, c.exponent, c.friction};
  }

  template <class S>
  EG_INLINE static NormalResponse<S> normal(const Pair<S>& p, const S& overlap) {
    const S slope = select(overlap > S(0.0), p.h * power(max(overlap, S(1e-30)), p.exponent - S(1.0)), S(0.0));
    const S kn = p.exponent * slope;
    return {slope * overlap, kn, p.ratio * kn};
  }
  static double normal_energy(const Pair<double>& p, double overlap) {
    return normal<double>(p, overlap).force * overlap / (p.exponent + 1);
  }

  template <class S>
  EG_INLINE static Response<S> respond(const Pair<S>& p, const Strain<S>& strain, std::array<S, 3>& h) {
    return cumulative_shear(normal<S>(p, strain.overlap), p.friction, strain.slip, h);
  }
};
static_assert(ContactLaw<HertzExponent>);

}  // namespace eg
