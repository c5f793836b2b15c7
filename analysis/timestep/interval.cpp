#include "timestep/interval.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "assembly/stiffness.hpp"
#include "eigen/dense.hpp"
#include "timestep/estimates.hpp"
#include "timestep/lower_end.hpp"
#include "timestep/random_test.hpp"
#include "timestep/upper_end.hpp"

namespace eg {
namespace {

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

/// What a random test says of the width that no proof reached.
void look_closer(const Network& network, const IntervalOptions& options, StepInterval& interval) {
  const double sigma = interval.lambda_lower * (1 + options.loose);
  if (interval.lambda_upper <= sigma) return;
  const RandomTest test = random_test(network, interval.lambda_lower, sigma, options.seed);
  interval.products += test.products;
  if (test.below) interval.lambda_probable = sigma, interval.probable_error = test.error;
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

/// Walls that answer forces: held still they bound λmax from below, with springs that give from above.
StepInterval interval_beside_bodies(const Network& network, const IntervalOptions& options) {
  Network held = network, giving = network;
  for (auto& s : held.springs) s.give = 1;
  for (auto& s : giving.springs) s.normal *= s.give, s.tangential *= s.give, s.give = 1;
  StepInterval interval = step_interval(held, options);
  const StepInterval above = step_interval(giving, options);
  interval.lambda_upper = above.lambda_upper, interval.dt_safe = above.dt_safe;
  interval.method_upper = above.method_upper + ", walls that answer";
  interval.lambda_probable = above.lambda_probable, interval.dt_probable = above.dt_probable;
  interval.probable_error = above.probable_error;
  interval.products += above.products, interval.seconds += above.seconds;
  return interval;
}

}  // namespace

StepInterval step_interval(const Network& network, const IntervalOptions& options) {
  if (std::ranges::any_of(network.springs, [](const Spring& s) { return s.give > 1; }))
    return interval_beside_bodies(network, options);
  const auto begin = std::chrono::steady_clock::now();
  StepInterval interval;
  if (network.springs.empty()) {
    interval.method_lower = interval.method_upper = "no springs";
  } else if (total_dofs(network) <= options.dense_limit) {
    solve_densely(network, interval);
  } else {
    const Sides sides(network);
    const ScalarWeights weights = sweep_scalars(sides, {});
    if (weights.known > 0) {
      find_lower_end(sides, weights, options, interval);
      UpperEnd upper = find_upper_end(sides, weights, {interval.lambda_lower, options.width, options.loose});
      interval.lambda_upper = upper.value;
      interval.method_upper = std::move(upper.method);
      look_closer(network, options, interval);
    }
  }
  if (interval.lambda_upper > 0)
    describe_mode(network, interval);
  else
    interval.mode.clear();
  interval.dt_safe = 2 / std::sqrt(interval.lambda_upper) * (1 - step_error);
  if (interval.probable_error > 0) interval.dt_probable = 2 / std::sqrt(interval.lambda_probable) * (1 - step_error);
  interval.dt_limit_upper = 2 / std::sqrt(interval.lambda_lower) * (1 + step_error);
  interval.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return interval;
}

}  // namespace eg
