#pragma once
// Invariants of symmetric tensors (stress, fabric) in 3D or 2D; a 2D tensor fills the xx, xy, yy places.
#include <array>

#include "base/vec.hpp"

namespace eg {

/// p = tr σ / D.
double mean_value(const Mat3&, int dimension);

/// q = √(3/2 s:s) in 3D, √(2 s:s) in 2D, s = σ − p 1: σ1 − σ3 when two principal values are equal, σ1 − σ2 in 2D.
double deviator(const Mat3&, int dimension);

/// s_a:s_b of the deviators of two tensors (symmetric parts).
double deviator_product(const Mat3& a, const Mat3& b, int dimension);

/// How much `part` gives to the deviator of `whole`: s_part:s_whole/(s_whole:s_whole). Shares of parts that add up to
/// the whole add up to 1; one may be negative or above 1. Means little where the whole is nearly isotropic; 0 when it
/// is exactly so.
double deviator_share(const Mat3& part, const Mat3& whole, int dimension);

/// Eigenvalues, largest first, and unit axes of the symmetric part; 2D: the third value is 0. Jacobi's rotations
/// (1846), accurate to round-off.
struct Principal {
  std::array<double, 3> values{};
  std::array<Vec3, 3> axes{};
};
Principal principal(const Mat3&, int dimension);

}  // namespace eg
