#pragma once
// Eigenvalues of shared matrices by SLEPc (Hernandez, Roman and Vidal 2005).
#include <complex>
#include <vector>

#include "slepc/session.hpp"

namespace eg {

struct SlepcPair {
  std::complex<double> value;  ///< [1/s²]; of the quadratic problem s = 1/Δt [1/s]
  double residual = 0;         ///< ‖Ax − μx‖ over |μ|, ‖x‖ = 1
};

struct SlepcResult {
  std::vector<SlepcPair> pairs;  ///< that converged; the one sought first
  int products = 0;              ///< with the matrix
};

struct SlepcOptions {
  double tolerance = 1e-11;  ///< relative residual
  int count = 1;             ///< eigenvalues wanted
  int basis = 0;             ///< vectors kept; 0: SLEPc's choice
  int restarts = 2000;       ///< at most
};

/// Largest eigenvalue of a symmetric matrix by Krylov–Schur: the Rayleigh quotient of the vector found, so never above
/// λmax but for round-off. Throws RunError when nothing converged.
SlepcResult largest_symmetric(::Mat matrix, const SlepcOptions& options = {});

/// Eigenvalues at one end of the spectrum of a general real matrix by Krylov–Schur; complex ones as pairs. No pairs
/// when none converged.
SlepcResult general_end(::Mat matrix, EPSWhich end, const SlepcOptions& options);

/// Largest s of (4s² − 2s C − K) x = 0, K and C symmetric and mass-scaled: the damped limit is Δt = 1/s. By the
/// two-level orthogonal Arnoldi method (Lu, Su and Bai 2016; Campos and Roman 2016). Throws RunError when nothing
/// converged.
SlepcResult quadratic_limit(::Mat k, ::Mat c, const SlepcOptions& options = {});

}  // namespace eg
