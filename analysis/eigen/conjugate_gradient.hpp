#pragma once
// Preconditioned conjugate gradients (Hestenes and Stiefel 1952) that stop on the error of the energy, which is what
// moduli are made of, instead of the residual.
//
// Step k lowers the energy ½xᵀAx − bᵀx by half of δ_k = α_k r_kᵀz_k, and ‖x* − x_k‖²_A = Σ_{j≥k} δ_j: so the sum of the
// last d terms tells the error of d steps ago, from below, and nearly all of it (Strakoš and Tichý 2002). That sum is
// what is reported and held against the tolerance: the error of now is smaller.
#include <algorithm>
#include <span>
#include <vector>

#include "eigen/operator.hpp"
#include "eigen/vectors.hpp"

namespace eg {

struct ConjugateGradientOptions {
  double tolerance = 1e-10;  ///< of the energy: error ≤ tolerance (reference − bᵀx)
  double reference = 0;  ///< energy that bᵀx is taken from: twice that of the load with x = 0; 0: bᵀx itself counts
  int max_iterations = 20000;
};

struct ConjugateGradientResult {
  int iterations = 0;
  double energy = 0;    ///< bᵀx = xᵀAx
  double error = 0;     ///< estimate of ‖x* − x‖²_A, see above
  double residual = 0;  ///< √(rᵀz) over that of x = 0, by the recurrence
  bool converged = false;
};

/// x of A x = b for a symmetric positive semidefinite A and b in its range; x is overwritten. P: z = P r, symmetric
/// positive definite. The same bit for bit for any number of threads if A and P are.
template <LinearOperator A, LinearOperator P>
ConjugateGradientResult conjugate_gradient(const A& a, const P& precondition, std::span<const double> b,
                                           std::span<double> x, const ConjugateGradientOptions& options = {}) {
  ConjugateGradientResult result;
  std::fill(x.begin(), x.end(), 0.0);
  std::vector<double> r(b.begin(), b.end()), z(b.size()), p(b.size(), 0.0), q(b.size());
  std::vector<double> drops;  // δ
  precondition.apply(r, z);
  double rho = dot(r, z), before = rho;
  double stiffest = 0;  // largest pᵀAp/pᵀp so far
  const auto allowed = [&] {
    const double left = options.reference > 0 ? options.reference - result.energy : result.energy;
    return options.tolerance * std::max(left, 1e-6 * options.reference);
  };
  const double first = rho, nothing = 1e-28 * std::max(options.reference, first);
  while (rho > nothing && result.iterations < options.max_iterations) {
    scale_and_add(p, result.iterations == 0 ? 0.0 : rho / before, z);
    a.apply(p, q);
    const double curvature = dot(p, q), square = dot(p, p);
    stiffest = std::max(stiffest, curvature / square);
    if (!(curvature > 1e-15 * stiffest * square)) {  // round-off along what A does not resist: nothing else is left
      result.error = rho, result.converged = rho <= allowed();
      break;
    }
    const double alpha = rho / curvature;
    add_scaled(x, alpha, p);
    add_scaled(r, -alpha, q);
    drops.push_back(alpha * rho);
    result.energy += drops.back();
    ++result.iterations;
    precondition.apply(r, z);
    before = rho, rho = dot(r, z);

    const std::size_t delay = 10 + drops.size() / 5;
    if (drops.size() < delay) continue;
    result.error = 0;
    for (std::size_t k = drops.size() - delay; k < drops.size(); ++k) result.error += drops[k];
    result.converged = result.error <= allowed();
    if (result.converged) break;
  }
  if (!(rho > nothing)) result.converged = true, result.error = std::max(rho, 0.0);
  result.residual = first > 0 ? std::sqrt(std::max(rho, 0.0) / first) : 0;
  return result;
}

}  // namespace eg
