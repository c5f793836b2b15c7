#pragma once
// Invariants of symmetric tensors (stress, fabric) in 3D or 2D; a 2D tensor fills the xx, xy, yy places.
#include <array>

#include "base/vec.hpp"

namespace eg {

/// p = tr σ / D.
double mean_value(const Mat3&, int dimension);

/// q = √(3/2 s:s) in 3D, √(2 s:s) in 2D, s = σ − p 1: σ1 − σ3 when two principal values are equal, σ1 − σ2 in 2D.
double deviator(const Mat3&, int dimension);

/// Eigenvalues of the symmetric part, largest first; 2D: the third is 0. Jacobi's rotations (1846), accurate to
/// round-off.
std::array<double, 3> principal_values(const Mat3&, int dimension);

}  // namespace eg
