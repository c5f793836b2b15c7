#pragma once
// Moduli of a network: strain it, let the grains move until they are in equilibrium, and add up the energy.
//
//   C_ab = (1/V) Σ_c (Δ_c,a + e_c,a)ᵀ k_c (Δ_c,b + e_c,b),   Δ = B u,   K u_a = −Bᵀ k e_a
//
// Summed like this, an error E of u changes C_aa by EᵀKE/V ≥ 0 only: the result is not below the exact one, and its
// error is the square of that of u.
#include <Eigen/Core>
#include <functional>
#include <string>

#include "stiffness/load_cases.hpp"

namespace eg {

struct RelaxationOptions {
  enum class Solver { automatic, conjugate_gradients, cholesky };
  Solver solver = Solver::automatic;          ///< automatic: Cholesky up to 12,000 degrees of freedom
  double tolerance = 1e-10;                   ///< relative error of each C_aa, by its estimate (conjugate gradients)
  std::function<void(double)> progress = {};  ///< called with the number of loads done
};

struct RelaxedModuli {
  Eigen::MatrixXd affine;              ///< no relaxation: all grains follow the jumps [Pa]
  Eigen::MatrixXd normal, tangential;  ///< shares of the springs' two parts [Pa]
  Eigen::MatrixXd total() const { return normal + tangential; }
  double error = 0;      ///< largest relative error of a C_aa, an estimate: C_aa (1 − error) ≤ exact ≤ C_aa
  double asymmetry = 0;  ///< largest |C_ab − C_ba|/√(C_aa C_bb) of the moduli by stress, which are not squares: of
                         ///< first order in the error of u
  int iterations = 0;    ///< of all loads
  bool converged = true;
  std::string method;
};

/// Moduli [Pa] of springs in the volume V [m³]. K may be singular: rigid translations, grains without springs and spins
/// that move no contact do no harm. Deterministic for any number of threads.
RelaxedModuli relax(const Network& network, const LoadCases& loads, double volume,
                    const RelaxationOptions& options = {});

}  // namespace eg
