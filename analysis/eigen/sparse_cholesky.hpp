#pragma once
// Sparse Cholesky factorisation (SuiteSparse CHOLMOD, supernodal; Chen, Davis, Hager and Rajamanickam 2008), ordered by
// nested dissection (METIS; Karypis and Kumar 1998) of the graph of blocks: one vertex a grain, not a degree of
// freedom.
#include <Eigen/SparseCore>
#include <cstddef>
#include <memory>
#include <span>

namespace eg {

/// L Lᵀ = P A Pᵀ of a symmetric matrix. Move-only; keeps the ordering as long as the pattern does not change.
class SparseCholesky {
 public:
  /// `block`: rows that belong together, e.g. the degrees of freedom of a grain; it must divide the rows of the
  /// matrices.
  explicit SparseCholesky(int block = 1);
  ~SparseCholesky();
  SparseCholesky(SparseCholesky&&) noexcept;
  SparseCholesky& operator=(SparseCholesky&&) noexcept;

  /// Factorises A, of which the lower triangle is read; false when a pivot is not positive or an entry not finite: then
  /// A is not positive definite, up to round-off, and there is nothing to solve with. Throws RunError when memory ends.
  bool factorise(const Eigen::SparseMatrix<double>& a);

  /// x = A⁻¹ b after a successful factorise(); x and b may be the same.
  void solve(std::span<const double> b, std::span<double> x);

  /// Numbers in the factor: 8 bytes each.
  std::size_t factor_entries() const;

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

/// What must be subtracted from the diagonal of A for success of factorise() to prove that A itself is positive
/// definite. Cholesky that runs to its end is exact for a matrix A + E with |E_ij| ≤ (n + 8) ε √(a_ii a_jj), whatever
/// the order of its sums (Demmel 1989; Higham 2002, section 10.1), so ‖E‖ ≤ (n + 8) ε tr A, here twice that.
double cholesky_margin(const Eigen::SparseMatrix<double>& a);

}  // namespace eg
