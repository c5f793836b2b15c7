#pragma once
// Linear springs with Coulomb friction (Cundall & Strack 1979).
#include <numbers>

#include "contact/law.hpp"

namespace eg {

/// What the shear spring remembers: `cumulative` all slip since the contact was made (Cundall and Strack 1979, PFC),
/// `incremental` that of the last step alone, F_s = ks Δs, as the first deformation analyses with discrete elements
/// did.
enum class ShearSpring { cumulative, incremental };

/// F_n = kn δ, F_s += ks Δs, |F_s| ≤ µ F_n. Either kn and ks are given, or PFC's deformability: kn = A E*/L with
/// A = π min(R)² (2D: 2 min(R), unit thickness), L = R1 + R2 (wall: L = R1), ks = kn/k*.
template <ShearSpring spring>
struct LinearLaw {
  static constexpr std::string_view name = spring == ShearSpring::cumulative ? "linear" : "linear-incremental";
  static constexpr std::size_t history_vectors = 1, history_scalars = 0;

  static std::vector<ConstantSet> constant_sets() {
    return {{{"normal_stiffness", &Material::normal_stiffness}, {"shear_stiffness", &Material::shear_stiffness}},
            {{"effective_modulus", &Material::effective_modulus}, {"stiffness_ratio", &Material::stiffness_ratio}}};
  }

  template <class S>
  struct Constants {
    S kn;          ///< [N/m], 0 by deformability
    S volume;      ///< π E* [Pa] in 3D by deformability, else 0: kn = volume·r²/L
    S area;        ///< 2 E* [Pa] in 2D by deformability, else 0: kn = area·r/L
    S ks_over_kn;  ///< [-]
    S friction;    ///< µ [-]
  };
  template <class S>
  struct Pair {
    S kn, ks, friction;
  };

  static Constants<double> constants(const Material& a, const Material& b, int dimension) {
    const double mu = std::min(a.friction, b.friction);
    const auto series = [](double x, double y) { return 2 * x * y / (x + y); };  // two half springs in series
    if (!std::isnan(a.normal_stiffness)) {
      const double kn = series(a.normal_stiffness, b.normal_stiffness);
      const double ks = a.shear_stiffness + b.shear_stiffness > 0 ? series(a.shear_stiffness, b.shear_stiffness) : 0.0;
      return {kn, 0, 0, ks / kn, mu};
    }
    const double e = series(a.effective_modulus, b.effective_modulus);
    const double ratio = 2 / (a.stiffness_ratio + b.stiffness_ratio);
    return dimension == 3 ? Constants<double>{0, std::numbers::pi * e, 0, ratio, mu}
                          : Constants<double>{0, 0, 2 * e, ratio, mu};
  }

  template <class S>
  EG_INLINE static Pair<S> pair(const Constants<S>& c, const Sizes<S>& sizes) {
    const S kn = c.kn + (c.volume * sizes.smaller + c.area) * sizes.smaller * reciprocal(sizes.length);
    return {kn, kn * c.ks_over_kn, c.friction};
  }

  template <class S>
  EG_INLINE static NormalResponse<S> normal(const Pair<S>& p, const S& overlap) {
    // A spring without memory acts on the last half step's velocity, as a dashpot ks Δt would. With dashpots C leapfrog
    // is stable as long as 4M − 2Δt C − Δt² K is positive definite: such a spring counts twice.
    return {p.kn * overlap, p.kn, spring == ShearSpring::cumulative ? p.ks : S(2.0) * p.ks};
  }
  static double normal_energy(const Pair<double>& p, double overlap) { return 0.5 * p.kn * overlap * overlap; }

  template <class S>
  EG_INLINE static Response<S> respond(const Pair<S>& p, const Strain<S>& strain, std::array<S, 3>& h) {
    auto n = normal<S>(p, strain.overlap);
    n.tangential = p.ks;
    Vec<S> trial = strain.slip * n.tangential;
    if constexpr (spring == ShearSpring::cumulative) trial += history_vector(h, 0);
    const Vec<S> shear = coulomb(trial, p.friction * n.force);
    set_history_vector(h, 0, shear);
    return {n, shear, trial};
  }
};
using Linear = LinearLaw<ShearSpring::cumulative>;
using LinearIncremental = LinearLaw<ShearSpring::incremental>;
static_assert(ContactLaw<Linear> && ContactLaw<LinearIncremental>);

}  // namespace eg
