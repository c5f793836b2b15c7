#pragma once
#include <span>

#include "timestep/matrix_weights.hpp"

namespace eg {

struct IncompleteCholesky {
  bool below = false;       ///< proved: the patch lies below sigma
  std::size_t dropped = 0;  ///< fill blocks given up
  std::size_t kept = 0;     ///< blocks of the factor off its diagonal
};

/// Tries to prove σ − A_P ≻ 0 by a robust incomplete block Cholesky factorisation, 6×6 blocks a grain.
///
/// A_P is M^−½KM^−½ with contacts between grains of the patch P whole and all others split. If every other
/// grain has λmax(S_i) < σ with the same weights, then λmax(M^−½KM^−½) < σ (docs/certificates.md).
///
/// Grains are eliminated in the order given: stiffest first. A fill block F between j and k that is small beside both
/// is dropped after ‖F‖r is taken from block j and ‖F‖/r from block k, so that each drop only lowers the matrix (Ajiz
/// and Jennings 1984); what drops cost must be smaller than the room left, so drop → 0 is the full factorisation.
/// Round-off is held against a reserve of 1e-6 σ; a patch that could need more is not certified.
IncompleteCholesky factorise_below(const WeightedContacts& contacts, std::span<const Index> patch, double sigma,
                                   double drop);

}  // namespace eg
