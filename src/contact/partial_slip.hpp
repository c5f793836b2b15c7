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

  /// |v|² and a little, so that it has a root.
  template <class S>
  EG_INLINE static S square_of(const Vec<S>& v) {
    return S(1e-60) + v.x * v.x + v.y * v.y + v.z * v.z;
  }

  /// θ = ∛(left/scale), without a division: θ = left · square, with square = 1/(scale θ²) = scale/∛(left · scale²)².
  template <class S>
  struct Share {
    S left;       ///< mµN − |T − R| − E, no less than 1e-9 mµN [N]
    S square;     ///< [1/N]
    S changed{};  ///< fraction by which `left` changed since the cube root from which `square` was continued
    EG_INLINE S value() const { return left * square; }
  };
  /// mµN
  template <class S>
  EG_INLINE static S scale(const Curve<S>& c, const S& limit) {
    return limit + limit * c.reversed;
  }
  template <class S>
  EG_INLINE static S within(const S& left, const S& scale) {
    return min(max(left, S(1e-9) * scale), scale);
  }

  /// T − R as a direction and a length, which may be < 0.
  template <class S>
  struct Way {
    Vec<S> unit;
    S length;
  };

  /// Effect of N + ΔN, grow = µΔN, on curve and force; gives θ and T − R after it. One cube root serves a contact for
  /// the whole step, unless it turns: what N takes of T while it falls changes θ little, so by the series of
  /// (1 + q)^(−2/3), exact to round-off for |q| ≤ 1e-3.
  template <class S>
  EG_INLINE static Share<S> press(Curve<S>& c, Vec<S>& shear, Way<S>& away, const S& grow, const S& limit) {
    const Vec<S> from = shear - c.origin;
    const S length2 = square_of(from), inverse = rsqrt(length2), distance = length2 * inverse;
    const S outward = grow * c.reversed, moved = select(length2 > S(2e-60), outward, S(0.0)), whole = scale(c, limit);
    away.unit = from * inverse;
    c.origin -= away.unit * outward;
    c.reach = select(c.reach > S(0.0), c.reach + (grow + outward), S(0.0));
    const S stuck = c.stuck + grow, lost = max(-stuck, S(0.0));
    c.stuck = max(stuck, S(0.0));

    const S free = whole - (distance + moved), left = within(free - stuck, whole);
    const S root = inverse_cube_root(left * (whole * whole)), steep = whole * root, square = root * steep;
    const S drop = min(lost - lost * (left * square), distance), after = max(free - c.stuck + drop, S(1e-9) * whole);
    shear -= away.unit * drop;
    away.length = distance + moved - drop;
    const S q = (after - left) * (square * steep);
    const S series = (S(1.0) - q * S(2.0 / 3)) + (q * q) * ((S(5.0 / 9) - q * S(40.0 / 81)) + (q * q) * S(110.0 / 243));
    return {after, square * series, q};
  }

  /// T after the slip Δs, before Coulomb's limit. `share`, `away`: as press() left them.
  template <class S>
  EG_INLINE static Vec<S> slide(Curve<S>& c, const Vec<S>& shear, const Way<S>& away, Share<S> share,
                                const Vec<S>& slip, const S& k0, const S& limit) {
    S along = dot(away.unit, slip), distance = away.length;
    const auto elsewhere = (along < S(0.0)) | (distance < S(0.0)) | (share.changed * share.changed > S(1e-6));
    if (any(elsewhere)) {
      along = select(distance < S(0.0), -along, along), distance = max(distance, -distance);
      const auto turns = along < S(0.0);
      c.reach = select(turns, distance * (S(2.0) - c.reversed), c.reach);
      c.origin = select(turns, shear, c.origin);
      c.reversed = select(turns, S(1.0), c.reversed);
      distance = select(turns, S(0.0), distance);
      const S whole = scale(c, limit), left = within(whole - (distance + c.stuck), whole);
      const S root = inverse_cube_root(left * (whole * whole));
      share.left = select(elsewhere, left, share.left);
      share.square = select(elsewhere, root * (root * whole), share.square);
    }
    const S length2 = square_of(slip), inverse = rsqrt(length2), step = length2 * inverse;
    const S sticking = min(k0 * step, c.stuck), k1 = sticking * inverse, k2 = k0 - k1;  // Δs takes T by k1 + k2 θ
    c.stuck = c.stuck - sticking;
    const auto apart = distance > S(1e-12) * limit;
    const S outward = select(apart, max(along, S(0.0)), step);
    return shear + slip * (k1 + k2 * mean_share(share, S(2.0 / 3.0) * k2 * outward));
  }

  /// Mean of θ over a slip by which θ² falls by `fall`/scale: (2/3)(θ² + θθ' + θ'²)/(θ + θ'), or its series in the
  /// fraction by which θ² falls.
  template <class S>
  EG_INLINE static S mean_share(const Share<S>& from, const S& fall) {
    const S theta = from.value(), p = fall * from.square;
    const S series = (S(1.0 / 4) + p * S(1.0 / 24)) + (p * p) * (S(1.0 / 64) + p * S(1.0 / 128));
    const S mean = theta - theta * p * series;
    const auto far = p > S(1e-3);
    if (!any(far)) return mean;
    const S next = theta * root(max(S(1.0) - p, S(1e-30)));
    return select(far, S(2.0 / 3.0) * (theta * theta + theta * next + next * next) * reciprocal(theta + next), mean);
  }

  /// Ends curves that have been followed to their end, or by sliding, and starts anew after pressing. Works on `trial`,
  /// which is there before `shear` and the same but for a contact that slides, whose curve ends anyway.
  template <class S>
  EG_INLINE static void close(Curve<S>& c, const Vec<S>& shear, const Vec<S>& trial, const S& limit) {
    const S zero(0.0);
    const Vec<S> away = trial - c.origin;
    const S left = c.reach - c.stuck, whole = dot(away, away), tried = dot(trial, trial), most = limit * limit;
    const auto ended = (left < zero) | (whole > left * left) | (tried > most);
    c.origin = select(ended, Vec<S>{zero, zero, zero}, c.origin);
    c.reach = select(ended, zero, c.reach), c.reversed = select(ended, zero, c.reversed);

    const S square = select(ended, min(tried, most), whole);
    const auto anew = (c.stuck * c.stuck > square) & (c.stuck > S(0.05) * limit * c.reversed);
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
    const S limit = max(p.friction * n.force, S(1e-90));
    Vec<S> shear = before;
    Way<S> away;
    const auto share = press(curve, shear, away, p.friction * (n.force - h[6]), limit);
    const Vec<S> trial = slide(curve, shear, away, share, strain.slip, n.tangential, limit);
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
