#pragma once
// From a network to an interval that contains the critical time step of the undamped leapfrog, Δt = 2/√λmax(M⁻¹K).
#include <cstdint>
#include <string>
#include <vector>

#include "assembly/network.hpp"
#include "timestep/splitting.hpp"

namespace eg {

struct IntervalOptions {
  std::size_t dense_limit = 600;  ///< degrees of freedom up to which the whole spectrum is computed; 0: never
  double tolerance = 1e-4;        ///< residual of the Ritz pair over its value
  double width = 1e-3;            ///< relative width in λ that is wanted of the interval …
  double loose = 1e-2;            ///< … and the one put up with where the first would cost too much
  std::uint64_t seed = 1;         ///< of the random start vector
};

struct StepInterval {
  double lambda_lower = 0, lambda_upper = 0;  ///< lambda_lower ≤ λmax(M⁻¹K) ≤ lambda_upper [1/s²]
  std::string method_lower, method_upper;
  double lambda_probable =
      0;  ///< λmax < lambda_probable unless with this probability of error [1/s²]; below lambda_upper
  double probable_error = 0;  ///< where no proof comes close; 0: the proof does, and there is nothing probable
  double dt_safe = 0;         ///< 2/√lambda_upper [s]: proved stable; infinite when nothing is stiff
  double dt_probable = 0;     ///< 2/√lambda_probable [s]
  double dt_limit_upper = 0;  ///< 2/√lambda_lower [s]: the limit is not above; a larger step is proved unstable
  double residual = 0;        ///< ‖Ax − θx‖ of the Ritz pair, on the grains it was sought on [1/s²]
  int products = 0;           ///< with the matrix
  double seconds = 0;         ///< wall clock
  Index grain = no_index;     ///< place in the network of the grain with the largest share of the mode
  double grain_share = 0;     ///< its share of |u|²_M
  int coordination = 0;       ///< its contacts, walls included
  double participation = 0;   ///< (Σp)²/Σp², p = |u_i|²_M: how many grains take part in the mode
  std::vector<double> mode;   ///< M^½u of the mode, length 1; empty when λmax = 0
};

/// The interval for a network of any size. Grains that cannot move, rattlers, and a network without springs (λ = 0,
/// infinite step) are fine.
StepInterval step_interval(const Network& network, const IntervalOptions& options = {});

}  // namespace eg
