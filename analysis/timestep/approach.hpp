#pragma once
// How contacts are taken to move until the next check: the only forecast behind a bound of the step.
#include "base/number.hpp"
#include "state/gather.hpp"

namespace eg {

/// How fast contacts are taken to close, over how fast they do.
inline constexpr double closing_margin = 1.5;

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

}  // namespace eg
