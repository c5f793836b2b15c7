#pragma once
// Hertz–Mindlin–Deresiewicz: a ring of the contact slips before the whole of it does (Mindlin and Deresiewicz 1953).
#include "base/power.hpp"
#include "contact/hertz_mindlin.hpp"
#include "contact/rough_hertz_mindlin.hpp"

namespace eg {

/// Normal force and stick stiffness k0 of `Base`; the shear force follows dT = k0 θ Δs along the curve it is on:
///   θ³ = 1 − (|T − R| + E)/(m µN),   first loading: R = 0, m = 1;   after a reversal: R the turning point, m = 2.
/// These are Mindlin and Deresiewicz's load, unload and reload laws with the sign of T replaced by vectors in the
/// contact plane, so that any path is followed (compare Jäger 2005; Kuhn 2018): a reversal is a step with (T − R)·Δs <
/// 0. A curve ends, and that of first loading goes on, when |T − R| reaches D: twice |T| of the turning point after a
/// first reversal, the distance between both turning points after a second one; a third one within a loop takes the
/// place of the second. Steps at constant N and direction are integrated in closed form: θ² falls linearly in s.
///
/// When N grows by ΔN, a force E = Σ µΔN can be carried without slip (θ = 1 until |Δs| > µΔN/k0); when it falls, T
/// loses µ(1 − θ)|ΔN|. Turning points move outwards by µΔN. A contact that was pressed together further than it has
/// been sheared since (E > |T − R|) starts anew from its present T, with m = 1, until it has carried E.
template <class Base>
struct PartialSlip {
  static constexpr std::string_view name = Base::partial_slip_name;
  static constexpr std::size_t history_vectors = 2, history_scalars = 4;  // T, R; N, E, D, whether reversed

  static std::vector<ConstantSet> constant_sets() { return Base::constant_sets(); }
  template <class S>
  using Constants = typename Base::template Constants<S>;
  template <class S>
  using Pair = typename Base::template Pair<S>;
  static auto constants(const Material& a, const Material& b, int dimension) {
    return Base::constants(a, b, dimension);
  }
  template <class S>
  EG_INLINE static Pair<S> pair(const Constants<S>& c, const Sizes<S>& sizes) {
    return Base::template pair<S>(c, sizes);
  }
  template <class S>
  EG_INLINE static NormalResponse<S> normal(const Pair<S>& p, const S& overlap) {
    return Base::template normal<S>(p, overlap);
  }
  static double normal_energy(const Pair<double>& p, double overlap) { return Base::normal_energy(p, overlap); }

  /// The curve a contact is on.
  template <class S>
  struct Curve {
    Vec<S> origin;  ///< R [N]
    S stuck;        ///< E ≥ 0 [N]
    S reach;        ///< D [N]; 0: first loading, which has no end
    S reversed;     ///< 1 after a reversal, else 0
  };

  /// 1/|v|, and |v| = that times |v|²; a vector of no length has a tiny one.
  template <class S>
  EG_INLINE static S inverse_length(const S& square) {
    return rsqrt(max(square, S(1e-60)));
  }
  /// 1/(mµN)
  template <class S>
  EG_INLINE static S inverse_scale(const Curve<S>& c, const S& inverse_limit) {
    return inverse_limit * (S(1.0) - S(0.5) * c.reversed);
  }

  /// θ³, and 1/θ: one cube root serves a contact for the whole step, unless it turns.
  template <class S>
  struct Share {
    S cube, inverse;
    EG_INLINE S value() const { return cube * inverse * inverse; }
  };
  /// θ³ at a distance |T − R| from the origin of the curve.
  template <class S>
  EG_INLINE static S cubed_share(const Curve<S>& c, const S& distance, const S& inverse_scale) {
    return min(max(S(1.0) - (distance + c.stuck) * inverse_scale, S(1e-9)), S(1.0));
  }
  /// The same with 1/θ = mµN/∛(left (mµN)²), left = θ³ mµN: the cube root need not wait for 1/(mµN).
  template <class S>
  EG_INLINE static Share<S> share_at(const Curve<S>& c, const S& distance, const S& limit, const S& inverse_limit) {
    const S scale = limit + limit * c.reversed;
    const S left = min(max(scale - (distance + c.stuck), S(1e-9) * scale), scale);
    return {left * inverse_scale(c, inverse_limit), scale * inverse_cube_root(left * (scale * scale))};
  }
  /// θ for another θ³, from one close by where it is: by the series of (1 + q)^(−1/3), exact to round-off for |q| ≤
  /// 1e-3.
  template <class S>
  EG_INLINE static Share<S> moved_to(const S& cube, const Share<S>& from) {
    const S q = (cube - from.cube) * (from.inverse * from.inverse * from.inverse);
    const S series = (S(1.0) - q * S(1.0 / 3)) + (q * q) * ((S(2.0 / 9) - q * S(14.0 / 81)) + (q * q) * S(35.0 / 243));
    S inverse = select(cube < S(1.0), from.inverse * series, S(1.0));
    const auto far = (max(q, -q) > S(1e-3)) & (cube < S(1.0));
    if (any(far)) inverse = select(far, inverse_cube_root(cube), inverse);
    return {cube, inverse};
  }

  /// T − R as a direction and a length, which may be < 0.
  template <class S>
  struct Way {
    Vec<S> unit;
    S length;
  };

  /// Effect of N + ΔN, grow = µΔN, on curve and force; gives θ and T − R after it.
  template <class S>
  EG_INLINE static Share<S> press(Curve<S>& c, Vec<S>& shear, Way<S>& away, const S& grow, const S& limit,
                                  const S& inverse_limit) {
    const Vec<S> from = shear - c.origin;
    const S square = dot(from, from), inverse = inverse_length(square), distance = square * inverse;
    const S outward = grow * c.reversed;
    away.unit = from * inverse;
    c.origin -= away.unit * outward;
    c.reach = select(c.reach > S(0.0), c.reach + grow * (S(1.0) + c.reversed), S(0.0));
    const S stuck = c.stuck + grow, lost = max(-stuck, S(0.0));
    c.stuck = max(stuck, S(0.0));
    const Share<S> share = share_at(c, distance + outward - lost, limit, inverse_limit);
    const S drop = min((S(1.0) - share.value()) * lost, distance);
    shear -= away.unit * drop;
    away.length = select(square > S(1e-60), distance + outward - drop, S(0.0));
    return share;
  }

  /// T after the slip Δs, before Coulomb's limit. `pressed`, `away`: as press() left them.
  template <class S>
  EG_INLINE static Vec<S> slide(Curve<S>& c, const Vec<S>& shear, const Way<S>& away, const Share<S>& pressed,
                                const Vec<S>& slip, const S& k0, const S& limit, const S& inverse_limit) {
    const S towards = dot(away.unit, slip), along = select(away.length < S(0.0), -towards, towards);
    const S whole = max(away.length, -away.length);
    const auto turns = along < S(0.0);
    c.reach = select(turns, whole * (S(2.0) - c.reversed), c.reach);
    c.origin = select(turns, shear, c.origin);
    c.reversed = select(turns, S(1.0), c.reversed);

    const S distance = select(turns, S(0.0), whole), scale = inverse_scale(c, inverse_limit);
    const Share<S> now = moved_to(cubed_share(c, distance, scale), pressed);
    const S step = root(max(dot(slip, slip), S(1e-60))), elastic = k0 * step;
    const S share = select(elastic > c.stuck, c.stuck * reciprocal(max(elastic, S(1e-200))), S(1.0));
    c.stuck = max(c.stuck - elastic, S(0.0));
    const auto apart = distance > S(1e-12) * limit;
    const S outward = select(apart, max(along, S(0.0)), step) * (S(1.0) - share);
    const S mean = mean_share(now, S(2.0 / 3.0) * k0 * outward * scale);
    return shear + slip * (k0 * share + (k0 - k0 * share) * mean);
  }

  /// Mean of θ over a slip by which θ² falls by `fall`: (2/3)(θ² + θθ' + θ'²)/(θ + θ'), or its series in fall/θ².
  template <class S>
  EG_INLINE static S mean_share(const Share<S>& from, const S& fall) {
    const S theta = from.value(), p = fall * (from.inverse * from.inverse);
    const S series = (S(1.0 / 4) + p * S(1.0 / 24)) + (p * p) * (S(1.0 / 64) + p * S(1.0 / 128));
    const S mean = theta - (theta * p) * series;
    const auto far = p > S(1e-3);
    if (!any(far)) return mean;
    const S next = root(max(theta * theta - fall, S(1e-30)));
    return select(far, S(2.0 / 3.0) * (theta * theta + theta * next + next * next) * reciprocal(theta + next), mean);
  }

  /// Ends curves that have been followed to their end, or by sliding, and starts anew after pressing.
  template <class S>
  EG_INLINE static void close(Curve<S>& c, const Vec<S>& shear, const Vec<S>& trial, const S& limit) {
    const S zero(0.0);
    const Vec<S> away = shear - c.origin;
    const S left = c.reach - c.stuck, whole = dot(away, away);
    const auto ended = (left < zero) | (whole > left * left) | (dot(trial, trial) > limit * limit);
    c.origin = select(ended, Vec<S>{zero, zero, zero}, c.origin);
    c.reach = select(ended, zero, c.reach), c.reversed = select(ended, zero, c.reversed);

    const S square = select(ended, dot(shear, shear), whole);
    const auto anew = (c.stuck * c.stuck > square) & (c.stuck > select(c.reversed > zero, S(0.05) * limit, zero));
    if (!any(anew)) return;
    c.reach = select(anew, max(c.stuck, c.reach - root(max(square, S(1e-60)))), c.reach);
    c.origin = select(anew, shear, c.origin);
    c.reversed = select(anew, zero, c.reversed), c.stuck = select(anew, zero, c.stuck);
  }

  template <class S>
  EG_INLINE static Response<S> respond(const Pair<S>& p, const Strain<S>& strain, std::array<S, 10>& h) {
    const auto n = normal<S>(p, strain.overlap);
    const Vec<S> before = history_vector(h, 0);
    Curve<S> curve{history_vector(h, 1), h[7], h[8], h[9]};
    const S limit = max(p.friction * n.force, S(1e-90)), inverse_limit = reciprocal(limit);
    Vec<S> shear = before;
    Way<S> away;
    const auto pressed = press(curve, shear, away, p.friction * (n.force - h[6]), limit, inverse_limit);
    const Vec<S> trial = slide(curve, shear, away, pressed, strain.slip, n.tangential, limit, inverse_limit);
    shear = coulomb(trial, limit);
    close(curve, shear, trial, limit);
    set_history_vector(h, 0, shear), set_history_vector(h, 1, curve.origin);
    h[6] = n.force, h[7] = curve.stuck, h[8] = curve.reach, h[9] = curve.reversed;

    Response<S> r{n, shear, trial};
    const Vec<S> ring = before + strain.slip * n.tangential - trial;  // T that the slipping ring did not take up
    r.loss = select(n.tangential > S(0.0),
                    S(0.5) * dot(before + shear, ring) * reciprocal(max(n.tangential, S(1e-200))), S(0.0));
    return r;
  }
};

using HertzMindlinPartialSlip = PartialSlip<HertzMindlin>;
using RoughPartialSlip = PartialSlip<RoughHertzMindlin>;
static_assert(ContactLaw<HertzMindlinPartialSlip> && ContactLaw<RoughPartialSlip>);

}  // namespace eg
