#pragma once
// The largest stable step of the damped leapfrog, 4M − 2Δt C − Δt² K ≻ 0, as an interval (docs/damping.md).
#include <functional>

#include "assembly/damping.hpp"
#include "timestep/interval.hpp"

namespace eg {

struct DampedInterval {
  double dt_safe = 0;                      ///< [s]; without local damping proved stable
  double dt_limit_upper = 0;               ///< [s]; proved unstable above, with any damping
  std::string method_lower, method_upper;  ///< ends of λ, as in StepInterval
  int rounds = 0;                          ///< intervals computed beyond the undamped one
};

/// The interval for a damped network, whose undamped interval is known. The upper end is the largest step that some
/// mode x allows, the positive root of a Δt² + 2b Δt = 4 with a = xᵀKx, b = xᵀCx, xᵀMx = 1; its minimum over x is the
/// limit, found as the extreme eigenvalue of a hyperbolic quadratic eigenproblem (Guo, Higham and Tisseur 2009). The
/// lower end follows from any proved λ ≥ λmax of the network damped at one step. Local damping α multiplies every force
/// by 1 + α in the mode that flips at every step, which makes the upper end exact; that nothing grows below is
/// measured, not proved.
DampedInterval damped_interval(const Network& network, const DampingSpec& damping, const StepInterval& undamped,
                               const IntervalOptions& options = {});

/// The step [s] below which no mode grows, given λ ≥ λmax of the network damped at `step` (damped_network); the largest
/// step at which none may, given λ ≤ λmax of it.
double proved_damped_step(double lambda, const DampingSpec& damping, double step);
double refuted_damped_step(double lambda, const DampingSpec& damping, double step);

/// The lower end alone, for use during a run. `bound` gives a proved upper bound of λmax of a network [1/s²]. With
/// dashpots it is asked again until two steps agree to 0.5 %, at most four times; `guess` is a step to begin with [s],
/// or 0.
double damped_safe_step(const Network& network, const DampingSpec& damping, double guess,
                        const std::function<double(const Network&)>& bound);

}  // namespace eg
