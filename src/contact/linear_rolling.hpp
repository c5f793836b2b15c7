#pragma once
// Linear springs with rolling resistance: a spring against relative rotation in the contact plane, with a slider.
#include "contact/linear.hpp"

namespace eg {

/// Forces as Linear. Rolling: M += kr Δθ with Δθ the rotation of j against i across n, kr = ks R̄²,
/// 1/R̄ = 1/R1 + 1/R2 (wall: R̄ = R), |M| ≤ µr R̄ N (Iwashita and Oda 1998; Wensrich and Katterfeld 2012). Twisting
/// about n meets no resistance.
struct LinearRolling {
  static constexpr std::string_view name = "linear-rolling";
  static constexpr std::size_t history_vectors = 2, history_scalars = 0;  // T, M
  static constexpr bool couples = true;

  static std::vector<ConstantSet> constant_sets() { return Linear::constant_sets(); }
  static ConstantSet further_constants() { return {{"rolling_friction", &Material::rolling_friction}}; }

  template <class S>
  struct Constants {
    Linear::Constants<S> linear;
    S rolling_friction;  ///< µr [-], the smaller of two materials
  };
  template <class S>
  struct Pair : Linear::Pair<S> {
    S radius;  ///< R̄ [m]
    S rolling_friction;
  };

  static Constants<double> constants(const Material& a, const Material& b, int dimension) {
    return {Linear::constants(a, b, dimension), std::min(a.rolling_friction, b.rolling_friction)};
  }

  template <class S>
  EG_INLINE static Pair<S> pair(const Constants<S>& c, const Sizes<S>& sizes) {
    return {Linear::pair<S>(c.linear, sizes), sizes.r_star(), c.rolling_friction};
  }

  template <class S>
  EG_INLINE static NormalResponse<S> normal(const Pair<S>& p, const S& overlap) {
    return Linear::normal<S>(p, overlap);
  }
  static double normal_energy(const Pair<double>& p, double overlap) { return Linear::normal_energy(p, overlap); }

  template <class S>
  EG_INLINE static Response<S> respond(const Pair<S>& p, const Strain<S>& strain, std::array<S, 6>& h) {
    const Vec<S> shear_before = history_vector(h, 0), couple_before = history_vector(h, 1);
    const auto n = normal<S>(p, strain.overlap);
    Response<S> r = cumulative_shear(n, p.friction, strain.slip, h);
    add_spring_work(r, shear_before, r.shear, r.unslipped, n.tangential, strain.slip);
    const S rolling = p.ks * p.radius * p.radius;
    const Vec<S> trial = couple_before + strain.roll * rolling;
    r.couple = coulomb(trial, p.rolling_friction * p.radius * n.force);
    set_history_vector(h, 1, r.couple);
    add_spring_work(r, couple_before, r.couple, trial, rolling, strain.roll);
    return r;
  }

  template <class S>
  EG_INLINE static Held<S> held(const std::array<S, 6>& h) {
    return {history_vector(h, 0), history_vector(h, 1), S(0.0)};
  }

  static Standing at_rest(const Pair<double>& p, double overlap, const std::array<double, 6>& h) {
    Standing s = standing_springs<LinearRolling>(p, overlap, history_vector(h, 0));
    const Vec3 couple = history_vector(h, 1);
    s.rolling = p.ks * p.radius * p.radius;
    if (s.rolling > 0) s.shear_energy += dot(couple, couple) / (2 * s.rolling);
    return s;
  }
};
static_assert(ContactLaw<LinearRolling> && HasCouples<LinearRolling>);

}  // namespace eg
