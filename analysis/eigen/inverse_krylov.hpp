#pragma once
// Eigenpairs of a symmetric matrix next to a shift: block Krylov space of (A − σ)⁻¹, every vector kept orthogonal to
// all others, Rayleigh–Ritz, thick restart (Grimes, Lewis and Simon 1994; Wu and Simon 2000). Blocks find eigenvalues
// that occur several times, as in crystals.
#include <Eigen/Core>
#include <cstdint>
#include <functional>

namespace eg {

struct Eigenpairs {
  Eigen::VectorXd value;     ///< ascending: Rayleigh quotients xᵀAx
  Eigen::VectorXd residual;  ///< ‖Ax − θx‖
  Eigen::MatrixXd vectors;   ///< a column each, orthonormal
  int solves = 0;            ///< vectors that (A − σ)⁻¹ was applied to
  bool converged = false;    ///< all residuals within the tolerance
};

struct InverseKrylovOptions {
  double tolerance = 1e-9;  ///< residual of the inverse over its eigenvalue
  int block = 12;
  int max_restarts = 60;
  std::uint64_t seed = 1;
};

/// Y = M X, a column at a time or all at once.
using BlockMap = std::function<void(const Eigen::MatrixXd& x, Eigen::MatrixXd& y)>;

/// The `count` eigenvalues nearest to σ. `inverse` applies (A − σ)⁻¹, `matrix` applies A. Only the subspace of vectors
/// with `active` = 1 is searched (entries 0 or 1; both maps must keep it). When all have converged the search goes on
/// from new random vectors until these bring nothing nearer: copies of an eigenvalue that the first ones missed.
/// Memory: about 8 rows (3 count + 100) bytes. Deterministic. Fewer than `count` come back only when there are no more.
Eigenpairs eigenpairs_near(Eigen::Index count, const BlockMap& inverse, const BlockMap& matrix,
                           const Eigen::VectorXd& active, const InverseKrylovOptions& options = {});

}  // namespace eg
