#pragma once
// Simplified Hertz–Mindlin: Hertz normal force, Mindlin no-slip tangential stiffness, Coulomb friction.
#include "contact/law.hpp"

namespace eg {

enum class Unloading { keep, rescale };

/// a = √(R*δ), N = (4/3) E* a δ, kn = 2 E* a, kt = 8 G* a; T += kt Δs, |T| ≤ µN (Mindlin 1949; Thornton et al. 2013).
/// Unloading::keep leaves T as it is when N drops (PFC default, geomechanics LAMMPS); Unloading::rescale shortens T
/// with the contact radius, T ← T a/a_old (LAMMPS mindlin_rescale, PFC hz_mode 1); a_old is the one history scalar
/// then.
template <Unloading unloading>
struct HertzMindlinLaw {
  static constexpr std::string_view name = unloading == Unloading::keep ? "hertz-mindlin" : "hertz-mindlin-rescale";
  static constexpr std::string_view partial_slip_name = "hertz-mindlin-deresiewicz";
  static constexpr std::size_t history_vectors = 1, history_scalars = unloading == Unloading::rescale ? 1 : 0;

  static std::vector<ConstantSet> constant_sets() {
    return {{{"shear_modulus", &Material::shear_modulus}, {"poisson", &Material::poisson}}};
  }

  template <class S>
  struct Constants {
    S e_star, g_star, friction;
  };
  template <class S>
  struct Pair {
    S e_star, g_star, product, length, friction;  // R* = product/length
  };

  /// 1/E* = Σ(1−ν²)/E with E = 2G(1+ν), so (1−ν)/(2G) a side; 1/G* = Σ(2−ν)/G.
  static Constants<double> constants(const Material& a, const Material& b, int /*dimension*/) {
    const double soft = (1 - a.poisson) / (2 * a.shear_modulus) + (1 - b.poisson) / (2 * b.shear_modulus);
    const double slip = (2 - a.poisson) / a.shear_modulus + (2 - b.poisson) / b.shear_modulus;
    return {1 / soft, 1 / slip, std::min(a.friction, b.friction)};
  }

  template <class S>
  EG_INLINE static Pair<S> pair(const Constants<S>& c, const Sizes<S>& sizes) {
    return {c.e_star, c.g_star, sizes.product, sizes.length, c.friction};
  }

  template <class S>
  EG_INLINE static NormalResponse<S> normal(const Pair<S>& p, const S& overlap) {
    const S a = root_of_ratio(p.product * overlap, p.length);
    const S ea = p.e_star * a;
    return {S(4.0 / 3.0) * ea * overlap, S(2.0) * ea, S(8.0) * p.g_star * a};
  }
  static double normal_energy(const Pair<double>& p, double overlap) {
    return 0.4 * normal<double>(p, overlap).force * overlap;
  }

  template <class S>
  EG_INLINE static Response<S> respond(const Pair<S>& p, const Strain<S>& strain,
                                       std::array<S, 3 + history_scalars>& h) {
    const auto n = normal<S>(p, strain.overlap);
    Vec<S> old = history_vector(h, 0);
    if constexpr (unloading == Unloading::rescale) {
      const S a = n.tangential;  // proportional to the contact radius, as is its stored predecessor
      old = old * select(a < h[3], a / h[3], S(1.0));
      h[3] = a;
    }
    const Vec<S> trial = old + strain.slip * n.tangential;
    const Vec<S> shear = coulomb(trial, p.friction * n.force);
    set_history_vector(h, 0, shear);
    return {n, shear, trial};
  }
};

using HertzMindlin = HertzMindlinLaw<Unloading::keep>;
using HertzMindlinRescale = HertzMindlinLaw<Unloading::rescale>;
static_assert(ContactLaw<HertzMindlin> && ContactLaw<HertzMindlinRescale>);

}  // namespace eg
