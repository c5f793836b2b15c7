#include "timestep/interval.hpp"

#include <chrono>
#include <cmath>
#include <utility>

#include "assembly/apply.hpp"
#include "assembly/stiffness.hpp"
#include "eigen/dense.hpp"
#include "eigen/lanczos.hpp"
#include "timestep/collatz.hpp"
#include "timestep/estimates.hpp"

namespace eg {
namespace {

// Round-off of a Rayleigh quotient: sums of up to 4096/8 terms in eight lanes, then of the pieces (eigen/vectors.cpp),
// and of some tens of contacts a grain: below 1e4 ε for any network that fits a machine.
constexpr double quotient_error = 2e-12;
// 2/√λ is rounded three times.
constexpr double step_error = 1e-15;

/// Both ends from the whole spectrum.
void solve_densely(const Network& network, StepInterval& interval) {
  EigenResult top = dense_largest(dense_scaled_stiffness(network));
  const double margin = dense_relative_error(total_dofs(network)) * top.value;
  interval.lambda_lower = top.value - margin;
  interval.lambda_upper = top.value + margin;
  interval.method_lower = interval.method_upper = "dense";
  interval.residual = top.residual;
  interval.mode = std::move(top.vector);
}

void solve_below(const Network& network, const IntervalOptions& options, StepInterval& interval) {
  const StiffnessOperator a(network, StiffnessOperator::Scaling::mass);
  LanczosOptions lanczos;
  lanczos.tolerance = options.tolerance;
  lanczos.seed = options.seed;
  EigenResult top = lanczos_largest(a, lanczos);
  interval.lambda_lower = top.value * (1 - quotient_error);
  interval.method_lower = top.method;
  interval.residual = top.residual;
  interval.products = top.products;
  interval.mode = std::move(top.vector);
}

void solve_above(const Network& network, const IntervalOptions& options, StepInterval& interval,
                 SplittingWeights* weights) {
  SplittingOptions splitting;
  splitting.lower_bound = interval.lambda_lower;
  splitting.close_enough = options.width;
  interval.lambda_upper = splitting_bound(network, splitting, weights).value;
  interval.method_upper = "contact splitting";
  if (interval.lambda_upper <= interval.lambda_lower * (1 + options.width)) return;
  if (const double collatz = collatz_bound(network).value; collatz < interval.lambda_upper) {
    interval.lambda_upper = collatz;
    interval.method_upper = "block Collatz-Wielandt";
  }
}

void describe_mode(const Network& network, StepInterval& interval) {
  const auto width = static_cast<std::size_t>(network.dofs_per_grain());
  double sum = 0, squares = 0, largest = -1;
  for (std::size_t g = 0; g < network.size(); ++g) {
    double p = 0;
    for (std::size_t k = 0; k < width; ++k) p += interval.mode[g * width + k] * interval.mode[g * width + k];
    sum += p;
    squares += p * p;
    if (p > largest) largest = p, interval.grain = static_cast<Index>(g);
  }
  interval.grain_share = largest / sum;
  interval.participation = sum * sum / squares;
  interval.coordination = coordination_numbers(network)[interval.grain];
}

}  // namespace

StepInterval step_interval(const Network& network, const IntervalOptions& options, SplittingWeights* weights) {
  const auto begin = std::chrono::steady_clock::now();
  StepInterval interval;
  if (network.springs.empty()) {
    interval.method_lower = interval.method_upper = "no springs";
  } else if (total_dofs(network) <= options.dense_limit) {
    solve_densely(network, interval);
  } else {
    solve_below(network, options, interval);
    solve_above(network, options, interval, weights);
  }
  if (interval.lambda_upper > 0)
    describe_mode(network, interval);
  else
    interval.mode.clear();
  interval.dt_safe = 2 / std::sqrt(interval.lambda_upper) * (1 - step_error);
  interval.dt_limit_upper = 2 / std::sqrt(interval.lambda_lower) * (1 + step_error);
  interval.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return interval;
}

}  // namespace eg
