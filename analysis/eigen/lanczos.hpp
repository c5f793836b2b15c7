#pragma once
// Largest eigenvalue of a symmetric operator by plain Lanczos (Lanczos 1950; Paige 1971 on what round-off does to it).
//
// No basis is stored and nothing is reorthogonalised: lost orthogonality only repeats eigenvalues that have converged
// and never moves the top Ritz value above λmax by more than round-off. The Ritz vector x is built from the basis, kept
// in single precision where that is enough and memory allows, else by a second pass of the same recurrence; value and
// residual are computed from x itself, so value ≤ λmax up to round-off whatever happened before.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "eigen/operator.hpp"
#include "eigen/result.hpp"
#include "eigen/single_basis.hpp"
#include "eigen/tridiagonal.hpp"
#include "eigen/vectors.hpp"

namespace eg {

struct LanczosOptions {
  double tolerance = 1e-6;  ///< residual over value
  int min_steps = 60;       ///< before convergence is believed: a local mode may show late
  int max_steps = 1000;     ///< of one run; restarted from its Ritz vector at most max_restarts times
  int max_restarts = 3;
  std::uint64_t seed = 1;                          ///< of the random start vector
  std::size_t basis_bytes = std::size_t{1} << 30;  ///< most memory for the basis
  std::span<const double> start{};                 ///< start vector instead, any length but zero; empty: random
};

namespace detail {

constexpr double least_single_tolerance = 1e-5;  // below it the rounding of a basis of floats shows in the residual

/// The three-term recurrence β_{k+1} v_{k+1} = A v_k − α_k v_k − β_k v_{k−1}.
template <LinearOperator A>
class LanczosRecurrence {
 public:
  LanczosRecurrence(const A& a, std::vector<double> start)
      : a_(a), v_(std::move(start)), previous_(v_.size(), 0.0), work_(v_.size()) {}

  std::span<const double> vector() const { return v_; }
  double alpha() const { return alpha_; }
  double beta() const { return beta_; }

  /// α of the vector under way and β to the next one.
  void multiply() {
    a_.apply(v_, work_);
    add_scaled(work_, -beta_, previous_);
    alpha_ = dot(work_, v_);
    add_scaled(work_, -alpha_, v_);
    beta_ = norm(work_);
  }
  void advance() {
    std::swap(previous_, v_);
    std::swap(v_, work_);
    scale(v_, 1 / beta_);
  }

 private:
  const A& a_;
  std::vector<double> v_, previous_, work_;
  double alpha_ = 0, beta_ = 0;
};

struct LanczosTop {
  TridiagonalTop pair;
  int steps = 0;
};

template <LinearOperator A>
LanczosTop lanczos_pass(const A& a, const std::vector<double>& start, const LanczosOptions& options,
                        SingleBasis& basis) {
  LanczosRecurrence<A> recurrence(a, start);
  std::vector<double> alpha, beta;
  LanczosTop top;
  const auto dimension = static_cast<int>(std::min<std::size_t>(a.rows(), std::numeric_limits<int>::max()));
  const int least = std::min(options.min_steps, dimension);
  for (int k = 1;; ++k) {
    basis.push(recurrence.vector());
    recurrence.multiply();
    alpha.push_back(recurrence.alpha());
    const bool exhausted = recurrence.beta() <= 1e-14 * std::abs(*std::max_element(alpha.begin(), alpha.end()));
    if (exhausted || k >= options.max_steps || (k >= least && (k - least) % 8 == 0)) {
      top = {tridiagonal_top(alpha, beta), k};
      const double residual = recurrence.beta() * top.pair.vector.back();
      if (exhausted || k >= options.max_steps || residual <= 0.5 * options.tolerance * top.pair.value) return top;
    }
    beta.push_back(recurrence.beta());
    recurrence.advance();
  }
}

template <LinearOperator A>
std::vector<double> ritz_vector(const A& a, const std::vector<double>& start, const std::vector<double>& weights) {
  LanczosRecurrence<A> recurrence(a, start);
  std::vector<double> x(start.size(), 0.0);
  for (std::size_t k = 0; k < weights.size(); ++k) {
    add_scaled(x, weights[k], recurrence.vector());
    if (k + 1 == weights.size()) break;
    recurrence.multiply();
    recurrence.advance();
  }
  if (const double length = norm(x); length > 0) scale(x, 1 / length);
  return x;
}

}  // namespace detail

/// θ = xᵀAx and ‖Ax − θx‖ for a vector x of length 1: one product.
template <LinearOperator A>
void rayleigh_quotient(const A& a, EigenResult& result) {
  std::vector<double> product(result.vector.size());
  a.apply(result.vector, product);
  result.value = dot(result.vector, product);
  add_scaled(product, -result.value, result.vector);
  result.residual = norm(product);
  ++result.products;
}

/// Largest eigenvalue of A and its vector. Deterministic. An operator of no rows gives 0.
template <LinearOperator A>
EigenResult lanczos_largest(const A& a, const LanczosOptions& options = {}) {
  EigenResult result;
  result.method = "Lanczos";
  if (a.rows() == 0) {
    result.converged = true;
    return result;
  }
  std::vector<double> start(options.start.begin(), options.start.end());
  if (start.empty()) start = random_unit_vector(a.rows(), options.seed);
  scale(start, 1 / norm(start));
  for (int run = 0; run <= options.max_restarts && !result.converged; ++run) {
    const std::size_t room = options.tolerance < detail::least_single_tolerance ? 0 : options.basis_bytes;
    detail::SingleBasis basis(room);
    const auto top = detail::lanczos_pass(a, start, options, basis);
    result.products += top.steps;
    if (basis.complete()) {
      result.vector = basis.combine(top.pair.vector);
      scale(result.vector, 1 / norm(result.vector));
    } else {
      result.vector = detail::ritz_vector(a, start, top.pair.vector);
      result.products += top.steps - 1;
    }
    rayleigh_quotient(a, result);
    result.converged = result.residual <= options.tolerance * result.value || result.value == 0;
    start = result.vector;
  }
  return result;
}

}  // namespace eg
