#pragma once
// The spectrum of the exact tangent of the forces, sliding contacts included. It is not symmetric: complex eigenvalues
// are flutter, negative ones collapse, both of them physics of the packing that no time step removes.
#include "assembly/linearise.hpp"
#include "eigen/general_spectrum.hpp"

namespace eg {

struct ConsistentReport {
  std::size_t contacts = 0, sliding = 0;  ///< that touch; that are at Coulomb's limit
  double asymmetry = 0;                   ///< ‖A − Aᵀ‖/‖A‖ (Frobenius) of A = M^−½ K M^−½ [-]
  GeneralSpectrum spectrum;
  double radius_upper = 0;  ///< |μ| ≤ this, proved by block Collatz–Wielandt [1/s²]
  bool complete = false;    ///< all eigenvalues were computed, so the numbers of pairs are counts
};

struct ConsistentOptions {
  std::size_t dense_limit = 1200;  ///< degrees of freedom up to which the whole spectrum is computed
  int wanted = 8;                  ///< eigenvalues at each end otherwise
};

/// The report for a state with contact lists. `network` is its elastic linearisation (masses, shape).
ConsistentReport consistent_report(const Scene& scene, const State& state, const Network& network,
                                   const ConsistentOptions& options = {});

}  // namespace eg
