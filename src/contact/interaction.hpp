#pragma once
// From positions and motions of two grains to the force between them: the one function that the force loop (double,
// Batch), the assembler (Dual) and the measures share. Contact force on j: f = N n − T, on i: −f; moments about the
// centres: a_i n × T on i, a_j n × T on j.
#include "contact/law.hpp"

namespace eg {

template <class S>
struct Geometry {
  Vec<S> n;        ///< unit, from i to j
  S overlap;       ///< δ [m], > 0 when touching
  S shorten;       ///< how far inside the surface the contact point lies [m]
  S arm_i, arm_j;  ///< distance of the contact point from each centre, R − shorten [m]
};

/// How far along the branch the contact point lies. `middle`: the middle of the overlap, a = R − δ/2, so that the arms
/// sum to the branch length and rigid rotation moves no contact. `surface`: a = R, as the gran/* styles of LAMMPS.
enum class Arms { middle, surface };

/// `branch`: x_j − x_i [m]; `sum` = R_i + R_j. Two grains at one point have n = 0, so no force direction; the caller's
/// checks catch that.
template <class S>
EG_INLINE Geometry<S> grain_grain(const Vec<S>& branch, const S& ri, const S& sum, Arms arms) {
  const S d2 = max(dot(branch, branch), S(1e-300));
  const S inverse = rsqrt(d2);
  const S overlap = sum - d2 * inverse;
  const S shorten = arms == Arms::middle ? S(0.5) * overlap : S(0.0);
  return {branch * inverse, overlap, shorten, ri - shorten, sum - ri - shorten};
}

/// `height`: signed distance of the centre from the plane [m]; `inward`: the plane's normal, pointing to the grains.
template <class S>
EG_INLINE Geometry<S> grain_plane(const S& height, const Vec<S>& inward, const S& radius, Arms arms) {
  const S overlap = radius - height;
  const S shorten = arms == Arms::middle ? S(0.5) * overlap : S(0.0);
  return {-inward, overlap, shorten, radius - shorten, S(0.0)};
}

/// Motion of both sides during the last increment.
template <class S>
struct Motion {
  Vec<S> translation;  ///< u_j − u_i [m], with the affine part of a deforming cell
  Vec<S> turn;         ///< θ_i + θ_j [rad]
  Vec<S> roll;         ///< R_i θ_i + R_j θ_j [m]
  Vec<S> bend{};       ///< θ_j − θ_i [rad], for laws with couples
};
template <class S>
EG_INLINE Motion<S> motion_of(const Vec<S>& translation, const Vec<S>& ti, const S& ri, const Vec<S>& tj, const S& rj) {
  return {translation, ti + tj, ti * ri + tj * rj, tj - ti};
}
/// Against a wall, which does not turn: translation is the wall's minus the grain's.
template <class S>
EG_INLINE Motion<S> wall_motion(const Vec<S>& translation, const Vec<S>& turn, const S& radius) {
  return {translation, turn, turn * radius, -turn};
}

template <class S>
struct Increment {
  S approach;   ///< increase of overlap by the motion [m]
  Vec<S> slip;  ///< tangential [m]
  S twist;      ///< mean rotation of both sides about n [rad]
  Vec<S> bend;  ///< rotation of j against i across n [rad]
  S torsion;    ///< likewise about n [rad]
};

/// Δ = u_j − u_i − (a_i θ_i + a_j θ_j) × n with a = R − shorten, split along and across n.
template <bool rotation, class S>
EG_INLINE Increment<S> increment(const Geometry<S>& g, const Motion<S>& m) {
  const S along = dot(m.translation, g.n);
  Vec<S> slip = m.translation - g.n * along;
  if constexpr (rotation) {
    slip -= cross(m.roll - m.turn * g.shorten, g.n);
    const S torsion = dot(m.bend, g.n);
    return {-along, slip, S(0.5) * dot(m.turn, g.n), m.bend - g.n * torsion, torsion};
  } else {
    return {-along, slip, S(0.0), {S(0.0), S(0.0), S(0.0)}, S(0.0)};
  }
}

/// Turns a stored vector of the contact plane into the new plane, with the common spin about n, keeping its length.
template <class S>
EG_INLINE Vec<S> turn(const Vec<S>& old, const Vec<S>& n, const S& twist) {
  const Vec<S> spin = n * twist;
  const S out = dot(old, n), before = dot(old, old);
  const S square = twist * twist, wider = rough_reciprocal(max(before, S(1e-300))) * (S(1.0) + square);
  const Vec<S> turned = old - n * out + cross(spin, old);  // |turned|² = (before − out²)(1 + twist²)
  return turned * rsqrt_near_one(out * out * wider - square);
}

/// What a history holds.
template <class Law, class S>
EG_INLINE Held<S> held(const ContactHistory<Law, S>& h) {
  if constexpr (HasCouples<Law>) return Law::template held<S>(h);
  return {history_vector(h, 0)};
}

/// The slip by rotation that n and the arms of the last step would have given, less that of the new ones [m].
/// `curvature`: by how much n turns for a motion across it [1/m].
template <class S>
EG_INLINE Vec<S> change_of_roll(const Geometry<S>& g, const Motion<S>& m, const Increment<S>& inc, const S& curvature,
                                Arms arms) {
  const Vec<S> turned = (m.translation + g.n * inc.approach) * curvature;  // what n was turned by
  const Vec<S> change = cross(m.roll - m.turn * g.shorten, turned);
  if (arms == Arms::surface) return change;
  return change - cross(m.turn, g.n) * (S(0.5) * inc.approach);
}

/// What `before` did in the increment where it acted, in the plane and at the arms of the last step, less what it would
/// have done where it was turned to [J]. Works by the trapezoidal rule need it to be of second order in the step.
template <bool rotation, bool couples, class S>
EG_INLINE S work_of_turning(const Held<S>& before, const Geometry<S>& g, const Motion<S>& m, const Increment<S>& inc,
                            const S& curvature, Arms arms) {
  S work = -inc.approach * curvature * dot(before.shear, m.translation);
  if constexpr (rotation)
    work = work + dot(before.shear, change_of_roll(g, m, inc, curvature, arms)) -
           inc.twist * dot(cross(g.n, before.shear), inc.slip);
  if constexpr (couples)
    work =
        work +
        curvature * (inc.torsion * dot(before.couple, m.translation) - before.torsion * dot(m.translation, inc.bend)) -
        inc.twist * dot(cross(g.n, before.couple), inc.bend);
  return work;
}

/// Contact dashpots: ratio ξ of critical damping of the pair, 2ξ√(m* k); zero is off.
template <class S>
struct Dashpot {
  S normal_ratio{}, shear_ratio{};  ///< ξn, ξs [-]
  S inverse_mass{};                 ///< 1/m* = 1/m_i + 1/m_j [1/kg]; 0 where neither can move: no dashpot
  S per_dt{};                       ///< 1/Δt of the increment [1/s]
};

template <class S>
struct ContactForce {
  Vec<S> on_j;      ///< f [N]
  Vec<S> moment;    ///< n × T [N]; times the arm: moment on each grain
  Vec<S> couple{};  ///< M [N m], on i as +M and on j as −M; of laws with couples
  Response<S> law;  ///< the law's own part, without dashpots
  Held<S> before;   ///< what the history held
  Vec<S> dashpot;   ///< the dashpots' part of on_j [N]
};

/// Force of one contact. `touching` masks lanes that overlap; history of the others is cleared, unless a bond holds.
template <class Law, bool damped, class S, class M>
EG_INLINE ContactForce<S> interact(const typename Law::template Pair<S>& pair, const Geometry<S>& g,
                                   const Increment<S>& inc, M touching, ContactHistory<Law, S>& history,
                                   const Dashpot<S>& dashpot) {
  Strain<S> strain{select(touching, g.overlap, S(0.0)), inc.slip};
  if constexpr (HasCouples<Law>) strain.roll = inc.bend, strain.twist = inc.torsion, strain.opening = g.overlap;
  if constexpr (HasBonds<Law>) touching = touching | (history[Law::bond_value] > S(0.0));
  for (std::size_t k = 0; k < Law::history_vectors; ++k)
    set_history_vector(history, k, turn(history_vector(history, k), g.n, inc.twist));
  ContactForce<S> out;
  if constexpr (Law::history_vectors > 0) out.before = held<Law, S>(history);
  out.law = Law::template respond<S>(pair, strain, history);
  for (auto& h : history) h = select(touching, h, S(0.0));

  out.on_j = g.n * out.law.normal.force;
  if constexpr (Law::history_vectors > 0) {
    out.on_j -= out.law.shear;
    out.moment = cross(g.n, out.law.shear);
  }
  if constexpr (HasCouples<Law>) out.couple = out.law.couple + g.n * out.law.torsion;
  if constexpr (damped) {
    const auto critical = [&](const S& stiffness) {  // 2√(m* k)/Δt [N/m]
      return select(dashpot.inverse_mass > S(0.0), S(2.0) * root_of_ratio(stiffness, dashpot.inverse_mass), S(0.0)) *
             dashpot.per_dt;
    };
    const S cn = dashpot.normal_ratio * critical(out.law.normal.stiffness);
    out.dashpot = g.n * select(touching, cn * inc.approach, S(0.0));
    if (Law::history_vectors > 0 && any(dashpot.shear_ratio > S(0.0))) {
      // A sliding contact has no shear dashpot, or it would exceed Coulomb's limit.
      const Vec<S> lost = out.law.unslipped - out.law.shear;
      const S cs = dashpot.shear_ratio * critical(out.law.normal.tangential);
      const S stick = select(dot(lost, lost) > S(0.0), S(0.0), cs);
      const Vec<S> fs = inc.slip * select(touching, stick, S(0.0));
      out.dashpot -= fs;
      out.moment += cross(g.n, fs);
    }
    out.on_j += out.dashpot;
  }
  return out;
}

}  // namespace eg
