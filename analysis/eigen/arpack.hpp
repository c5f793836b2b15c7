#pragma once
// Largest eigenvalue by ARPACK's implicitly restarted Lanczos with full orthogonalisation (Sorensen 1992; Lehoucq,
// Sorensen and Yang 1998), by reverse communication: any operator will do.
#include <cstdint>
#include <memory>
#include <span>

#include "eigen/lanczos.hpp"
#include "eigen/operator.hpp"
#include "eigen/result.hpp"

namespace eg {

struct ArpackOptions {
  double tolerance = 1e-10;  ///< ARPACK's own: relative accuracy of the Ritz value
  int basis = 24;            ///< Lanczos vectors kept
  int max_restarts = 1000;
  std::uint64_t seed = 1;
};

/// One run of dsaupd. while (next()) output = A input; then take() the Ritz vector.
class ArpackIteration {
 public:
  /// rows ≥ 3.
  ArpackIteration(std::size_t rows, const ArpackOptions& options);
  ~ArpackIteration();
  ArpackIteration(ArpackIteration&&) noexcept;
  ArpackIteration& operator=(ArpackIteration&&) noexcept;

  /// Advances to the next product wanted; false when done. Throws RunError when ARPACK gives up.
  bool next();
  std::span<const double> input() const;
  std::span<double> output();
  std::vector<double> take();

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

/// Largest eigenvalue of A, which must have at least 3 rows.
template <LinearOperator A>
EigenResult arpack_largest(const A& a, const ArpackOptions& options = {}) {
  ArpackIteration iteration(a.rows(), options);
  EigenResult result;
  result.method = "ARPACK";
  while (iteration.next()) {
    a.apply(iteration.input(), iteration.output());
    ++result.products;
  }
  result.vector = iteration.take();
  scale(result.vector, 1 / norm(result.vector));
  rayleigh_quotient(a, result);
  result.converged = true;
  return result;
}

}  // namespace eg
