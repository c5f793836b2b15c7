#pragma once
// A proof of the time step in O(contacts): contact splitting.
//
// For any symmetric positive definite T a contact, |a + b|² ≤ aᵀ(1 + T)a + bᵀ(1 + T⁻¹)b, so with A = k^½ B M^−½
//   λmax(M^−½KM^−½) ≤ max_i λmax(S_i),  S_i = Σ Aᵀ(1 + T^±1)A over the contacts of grain i
// (+1 for the first grain of a contact, −1 for the second; weight 1 towards a wall or a fixed grain). Every T is a
// proof; good ones come from sweeps over scalars t and then, where the maximum is decided, over 3×3 matrices. The last
// step evaluates all S_i anew with a margin for round-off, so what the sweeps did does not matter to the proof.
#include <array>
#include <vector>

#include "timestep/sides.hpp"

namespace eg {

/// A symmetric 3×3 matrix: xx yy zz yz xz xy.
using SymmetricSix = std::array<double, 6>;

/// The choice of T, one a contact. May be kept and passed on to the next evaluation of a network with the same springs
/// in the same order (a warm start); one of another size is dropped.
struct SplittingWeights {
  std::vector<double> scalar;        ///< t, a spring
  std::vector<Index> matrix_spring;  ///< springs with a matrix T instead, ascending
  std::vector<SymmetricSix> matrix;  ///< T of those, positive definite
};

struct SplittingOptions {
  int scalar_sweeps = 30;      ///< at most; they stop when the bound stands still
  int matrix_sweeps = 12;      ///< at each exponent p = 9, 17, … 2049; 0: scalars only
  double hot = 0.9;            ///< matrices for contacts of grains with λmax(S_i) above this share of the maximum
  double lower_bound = 0;      ///< a known lower bound of λmax [1/s²] …
  double close_enough = 1e-3;  ///< … and the relative distance to it at which to stop
};

struct SplittingBound {
  double value = 0;        ///< λmax ≤ value [1/s²], round-off included
  Index grain = no_index;  ///< the grain that decides it
  int scalar_sweeps = 0, matrix_sweeps = 0;
};

/// Upper bound of λmax(M⁻¹K). Reads and replaces *weights if given.
SplittingBound splitting_bound(const Network& network, const SplittingOptions& options = {},
                               SplittingWeights* weights = nullptr);
SplittingBound splitting_bound(const Sides& sides, const SplittingOptions& options = {},
                               SplittingWeights* weights = nullptr);

}  // namespace eg
