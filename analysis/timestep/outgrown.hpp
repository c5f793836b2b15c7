#pragma once
// Which contacts may come to overlap more, or turn further, than they are allowed: one look at every listed pair, eight
// at a time.
#include <span>
#include <vector>

#include "base/number.hpp"
#include "state/gather.hpp"

namespace eg {

/// How fast contacts are taken to close, over how fast they do.
inline constexpr double closing_margin = 1.5;

/// Of a unit vector kept in single precision, as StandingBound::direction is.
inline constexpr double direction_error = 1e-7;

/// What contacts may do unnoticed: overlaps and directions as in StandingBound, and a value a grain [-], how far off
/// the directions of its contacts may be, |n − n₀|.
struct Leave {
  const StandingBound& bound;
  std::span<const double> turn;
};

/// Where StandingBound::direction keeps a component.
inline std::size_t direction_place(std::size_t entry, std::size_t component) {
  constexpr std::size_t lanes = Contacts::lanes;
  return (entry / lanes * 3 + component) * lanes + entry % lanes;
}
/// n of a pair as it was counted; 0 when it was not.
inline Vec3 counted_direction(const StandingBound& bound, std::size_t entry) {
  const auto at = [&](std::size_t k) { return bound.direction[direction_place(entry, k)]; };
  return {at(0), at(1), at(2)};
}
inline void set_direction(StandingBound& bound, std::size_t entry, const Vec3& n) {
  const auto at = [&](std::size_t k) -> float& { return bound.direction[direction_place(entry, k)]; };
  at(0) = static_cast<float>(n.x), at(1) = static_cast<float>(n.y), at(2) = static_cast<float>(n.z);
}

/// The same of eight pairs from `entry` on.
inline void set_directions(StandingBound& bound, std::size_t entry, const Vec<Batch>& n) {
  float* at = bound.direction.data() + direction_place(entry, 0);
  for (const Batch* component : {&n.x, &n.y, &n.z}) {
    const auto f = __builtin_convertvector(component->v, float __attribute__((vector_size(32))));
    __builtin_memcpy(at, &f, sizeof f);
    at += Contacts::lanes;
  }
}

/// How a contact moves, closing_margin included.
template <class S>
struct Approach {
  S speed;    ///< at which its overlap grows [m/s], ≥ 0 …
  S driven;   ///< … and what the cell or a wall has in it, which no contact force stops
  S turning;  ///< rate of its direction, |dn/dt| [1/s]
};

/// What makes the approach of all contacts of a state.
struct CommonMotion {
  std::array<Quad, Cell::images> shift;  ///< of periodic images [m]
  Mat3 closing;             ///< velocity gradient by which surfaces close in: the cell's, and growing radii
  double fastest_wall = 0;  ///< [m/s]

  explicit CommonMotion(const State& state);

  /// `velocity`: of j against i [m/s], peculiar; `inverse_distance`: 1/|branch|.
  template <class S>
  EG_INLINE Approach<S> approach(const Vec<S>& n, const Vec<S>& branch, const Vec<S>& velocity,
                                 const S& inverse_distance) const {
    Mat<S> gradient;
    for (std::size_t k = 0; k < 9; ++k) gradient.a[k] = S(closing.a[k]);
    const Vec<S> affine = gradient * branch, all = velocity + affine;
    const S opening = dot(all, n), zero(0.0), margin(closing_margin);
    return {margin * max(-opening, zero), margin * max(-dot(affine, n), zero),
            margin * root(max(dot(all, all) - opening * opening, zero)) * inverse_distance};
  }
  Approach<double> at_wall(const State& state, const WallContact& contact, const Vec3& n) const;
};

/// Pairs of State::contacts whose overlap or direction, going straight on, passes what is allowed, some whose direction
/// only comes near it; ascending.
std::vector<std::size_t> outgrown_pairs(const State& state, const Leave& leave, double time);
/// The same of State::wall_contacts.
std::vector<std::size_t> outgrown_walls(const State& state, const Leave& leave, double time);

}  // namespace eg
