#pragma once
// What a contact law is: pure functions from overlap, slip and history to forces, over any number type.
#include <array>
#include <concepts>
#include <string_view>

#include "base/number.hpp"
#include "contact/material.hpp"

namespace eg {

/// Motion of a contact during the last increment, as a law sees it.
template <class S>
struct Strain {
  S overlap;    ///< δ [m], > 0 when touching, 0 when not
  Vec<S> slip;  ///< Δs [m], increment of the tangential displacement of j against i
  // for laws with couples
  Vec<S> roll{};  ///< Δθ [rad], rotation of j against i across n
  S twist{};      ///< likewise about n
  S opening{};    ///< δ with its sign, < 0 for a gap [m]
};

/// What a law may know of the two bodies' sizes.
template <class S>
struct Sizes {
  S product;  ///< R1 R2 [m²]; against a wall R², so that R* = product/length there too
  S smaller;  ///< min(R1, R2) [m]; against a wall R
  S length;   ///< L = R1 + R2 [m]; against a wall R

  EG_INLINE S r_star() const { return product * reciprocal(length); }  ///< R* = R1 R2/(R1 + R2) [m]
};
template <class S>
EG_INLINE Sizes<S> grain_sizes(const S& ri, const S& rj) {
  return {ri * rj, min(ri, rj), ri + rj};
}
template <class S>
EG_INLINE Sizes<S> wall_sizes(const S& r) {
  return {r * r, r, r};
}

/// Response normal to the contact plane.
template <class S>
struct NormalResponse {
  S force;       ///< N [N], repulsive; < 0 only where a bond pulls
  S stiffness;   ///< kn = dN/dδ [N/m]
  S tangential;  ///< kt [N/m] of a sticking contact
};

template <class S>
struct Response {
  NormalResponse<S> normal;
  Vec<S> shear;  ///< T [N], acts on i as +T and on j as −T; lies in the contact plane
  Vec<S>
      unslipped;  ///< T that elastic sticking alone would have given [N]; differs from `shear` when the contact slides
  S loss{};       ///< dissipated in the increment otherwise than by |T| > µN [J]
  // of laws with couples
  Vec<S> couple{};    ///< M [N m] across n, acts on i as +M and on j as −M
  S torsion{};        ///< likewise about n
  S work{};           ///< done in the increment on all springs but the normal one [J]; `loss` holds all that is lost
  S pulled{}, cut{};  ///< 1 when the bond breaks by tension or by shear
};

/// Forces across n and couples that the history of a contact holds.
template <class S>
struct Held {
  Vec<S> shear;     ///< T [N]
  Vec<S> couple{};  ///< M across n [N m], of laws with couples
  S torsion{};      ///< likewise about n
};

/// A contact at rest: what K, the measures and the energies need of it.
struct Standing {
  NormalResponse<double> normal{};   ///< N, kn, kt, those of a bond included
  Vec3 shear;                        ///< T [N], likewise
  double rolling = 0, twisting = 0;  ///< stiffness against rotation of j against i, across and about n [N m]
  double normal_energy = 0;          ///< work of N from 0 to the overlap [J]
  double shear_energy = 0;           ///< of the other springs [J]; T²/(2kt) where kt depends on N
  bool bonded = false;
};

/// A law has
/// - name, history_vectors (3-vectors in the contact plane that turn with it, the first one the shear force T) and
///   history_scalars; history is stored in this order;
/// - constant_sets(): the material constants that it needs; every material of a scene gives exactly one of the sets, in
///   full, and all materials the same one;
/// - Constants<S>: what two materials give, all of type S, independent of radii; constants(a, b, dimension) makes them;
/// - Pair<S>: constants of one contact, made of Constants and Sizes;
/// - normal(pair, overlap) for overlap ≥ 0, zero force at 0;
/// - normal_energy(pair, overlap): the work of N from 0 to overlap [J];
/// - respond(pair, strain, history): new forces; history goes in and comes out;
/// - further_constants(), if it needs constants beside the set.
template <class L>
concept ContactLaw = requires(const Material& m, const typename L::template Constants<double>& c,
                              const typename L::template Pair<double>& p, double x, const Strain<double>& s,
                              std::array<double, L::history_vectors * 3 + L::history_scalars>& h) {
  { L::name } -> std::convertible_to<std::string_view>;
  { L::constant_sets() } -> std::same_as<std::vector<ConstantSet>>;
  { L::constants(m, m, 3) } -> std::same_as<typename L::template Constants<double>>;
  { L::template pair<double>(c, Sizes<double>{x, x, x}) } -> std::same_as<typename L::template Pair<double>>;
  { L::template normal<double>(p, x) } -> std::same_as<NormalResponse<double>>;
  { L::normal_energy(p, x) } -> std::same_as<double>;
  { L::template respond<double>(p, s, h) } -> std::same_as<Response<double>>;
};

/// A law that resists rotation of one grain against the other; at_rest(pair, overlap, history) gives its Standing,
/// held(history) what the history holds.
template <class L>
concept HasCouples = requires {
  requires L::couples;
};
/// A law with bonds: history value L::bond_value is > 0 while one holds, bond(history, overlap) makes one.
template <class L>
concept HasBonds = HasCouples<L> && requires {
  L::bond_value;
};

/// What the material of a scene must give beside one set of constants.
template <class L>
ConstantSet further_constants() {
  if constexpr (requires { L::further_constants(); })
    return L::further_constants();
  else
    return {};
}

template <class L>
inline constexpr std::size_t history_size = L::history_vectors * 3 + L::history_scalars;
template <class L, class S>
using ContactHistory = std::array<S, history_size<L>>;

template <class S, std::size_t H>
EG_INLINE Vec<S> history_vector(const std::array<S, H>& h, std::size_t k) {
  return {h[3 * k], h[3 * k + 1], h[3 * k + 2]};
}
template <class S, std::size_t H>
EG_INLINE void set_history_vector(std::array<S, H>& h, std::size_t k, const Vec<S>& v) {
  h[3 * k] = v.x, h[3 * k + 1] = v.y, h[3 * k + 2] = v.z;
}

/// Constants of every pair of materials, row after row; `friction` is µ in force of every pair in the same order.
template <class Law>
auto pair_constants(const std::vector<Material>& materials, const std::vector<double>& friction, int dimension) {
  std::vector<typename Law::template Constants<double>> table;
  for (const Material& a : materials)
    for (const Material& b : materials) {
      Material first = a, second = b;
      first.friction = second.friction = friction[table.size()];
      table.push_back(Law::constants(first, second, dimension));
    }
  return table;
}

/// Coulomb's limit: T is `trial`, shortened to µN where longer.
template <class S>
EG_INLINE Vec<S> coulomb(const Vec<S>& trial, const S& limit) {
  const S t2 = dot(trial, trial);
  const auto slides = t2 > limit * limit;
  return trial * select(slides, limit * rsqrt(max(t2, S(1e-300))), S(1.0));
}

/// T += kt Δs, |T| ≤ µN, with T as the first vector of the history.
template <class S, std::size_t H>
EG_INLINE Response<S> cumulative_shear(const NormalResponse<S>& n, const S& friction, const Vec<S>& slip,
                                       std::array<S, H>& h) {
  const Vec<S> trial = history_vector(h, 0) + slip * n.tangential;
  const Vec<S> shear = coulomb(trial, friction * n.force);
  set_history_vector(h, 0, shear);
  return {n, shear, trial};
}

/// Standing of a law's own springs, given T.
template <class Law>
Standing standing_springs(const typename Law::template Pair<double>& pair, double overlap, const Vec3& shear) {
  Standing s;
  s.normal = Law::template normal<double>(pair, overlap);
  s.normal_energy = Law::normal_energy(pair, overlap);
  s.shear = shear;
  if (s.normal.tangential > 0) s.shear_energy = dot(shear, shear) / (2 * s.normal.tangential);
  return s;
}

/// Work on a spring k, and what it lost of it, when its force went from `before` to `after` though sticking would have
/// led to `trial`; trapezoidal rule over the motion.
template <class S>
EG_INLINE void add_spring_work(Response<S>& r, const Vec<S>& before, const Vec<S>& after, const Vec<S>& trial,
                               const S& k, const Vec<S>& motion) {
  const Vec<S> mean = (before + after) * S(0.5);
  r.work = r.work + dot(mean, motion);
  r.loss = r.loss + select(k > S(0.0), dot(mean, trial - after) / max(k, S(1e-300)), S(0.0));
}

/// The law without friction: no shear, no history, no tangential stiffness.
template <class Law>
struct Frictionless {
  static constexpr std::string_view name = Law::name;
  static constexpr std::size_t history_vectors = 0, history_scalars = 0;
  template <class S>
  using Constants = typename Law::template Constants<S>;
  template <class S>
  using Pair = typename Law::template Pair<S>;
  static std::vector<ConstantSet> constant_sets() { return Law::constant_sets(); }
  static auto constants(const Material& a, const Material& b, int dimension) { return Law::constants(a, b, dimension); }
  template <class S>
  EG_INLINE static Pair<S> pair(const Constants<S>& c, const Sizes<S>& sizes) {
    return Law::template pair<S>(c, sizes);
  }
  template <class S>
  EG_INLINE static NormalResponse<S> normal(const Pair<S>& p, const S& overlap) {
    auto n = Law::template normal<S>(p, overlap);
    n.tangential = S(0.0);
    return n;
  }
  static double normal_energy(const Pair<double>& p, double overlap) { return Law::normal_energy(p, overlap); }
  template <class S>
  EG_INLINE static Response<S> respond(const Pair<S>& p, const Strain<S>& s, std::array<S, 0>&) {
    return {normal<S>(p, s.overlap), {S(0.0), S(0.0), S(0.0)}, {S(0.0), S(0.0), S(0.0)}};
  }
};

}  // namespace eg
