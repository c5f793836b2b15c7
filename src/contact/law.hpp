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
  S overlap;    ///< δ [m], > 0 when touching
  Vec<S> slip;  ///< Δs [m], increment of the tangential displacement of j against i
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
  S force;       ///< N [N], ≥ 0, repulsive
  S stiffness;   ///< kn = dN/dδ [N/m]
  S tangential;  ///< kt [N/m] of a sticking contact
};

template <class S>
struct Response {
  NormalResponse<S> normal;
  Vec<S> shear;  ///< T [N], acts on i as +T and on j as −T; lies in the contact plane
  Vec<S>
      unslipped;  ///< T that elastic sticking alone would have given [N]; differs from `shear` when the contact slides
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
/// - respond(pair, strain, history): new forces; history goes in and comes out.
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

/// Coulomb's limit: T is `trial`, shortened to µN where longer.
template <class S>
EG_INLINE Vec<S> coulomb(const Vec<S>& trial, const S& limit) {
  const S t2 = dot(trial, trial);
  const auto slides = t2 > limit * limit;
  if (!any(slides)) return trial;
  return trial * select(slides, limit * rsqrt(max(t2, S(1e-300))), S(1.0));
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
