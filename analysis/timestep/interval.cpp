#include "timestep/interval.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "assembly/apply.hpp"
#include "assembly/stiffness.hpp"
#include "eigen/dense.hpp"
#include "eigen/lanczos.hpp"
#include "timestep/collatz.hpp"
#include "timestep/estimates.hpp"
#include "timestep/incomplete_cholesky.hpp"
#include "timestep/patch.hpp"
#include "timestep/scalar_weights.hpp"

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

constexpr int shells = 2;        // of contacts around the grains that are not proved below λmax one by one
constexpr double crowded = 0.4;  // share of the grains from which on the patch is no longer local

/// The grains that splitting does not prove to be below sigma, with their surroundings, stiffest first.
std::vector<Index> stiff_patch(const Sides& sides, const BlockRanges& ranges, double sigma) {
  std::vector<Index> grains;
  for (std::size_t g = 0; g < sides.size(); ++g)
    if (ranges.high[g] >= sigma && !sides.of(g).empty()) grains.push_back(static_cast<Index>(g));
  grains = grow_patch(sides, std::move(grains), shells);
  std::sort(grains.begin(), grains.end(),
            [&](Index a, Index b) { return ranges.low[a] != ranges.low[b] ? ranges.low[a] > ranges.low[b] : a < b; });
  return grains;
}

/// The lower end from Lanczos on the stiffest grains, if they are few, else on all.
void solve_below(const Sides& sides, const ScalarWeights& weights, const IntervalOptions& options,
                 StepInterval& interval) {
  const Network& whole = sides.network();
  const auto patch = stiff_patch(sides, weights.ranges, weights.known);
  const bool local = static_cast<double>(patch.size()) <= crowded * static_cast<double>(sides.size());
  const Network part = local ? patch_network(sides, patch) : Network{};
  const StiffnessOperator a(local ? part : whole, StiffnessOperator::Scaling::mass);
  LanczosOptions lanczos;
  lanczos.tolerance = options.tolerance;
  lanczos.seed = options.seed;
  EigenResult top = lanczos_largest(a, lanczos);
  interval.lambda_lower = top.value * (1 - quotient_error);
  interval.method_lower = local ? "Lanczos on the stiffest grains" : top.method;
  interval.residual = top.residual;
  interval.products = top.products;
  if (!local) {
    interval.mode = std::move(top.vector);
    return;
  }
  const auto width = static_cast<std::size_t>(whole.dofs_per_grain());
  interval.mode.assign(total_dofs(whole), 0.0);
  for (std::size_t k = 0; k < patch.size(); ++k)
    std::copy_n(top.vector.begin() + static_cast<std::ptrdiff_t>(k * width), width,
                interval.mode.begin() + static_cast<std::ptrdiff_t>(patch[k] * width));
}

/// One try at a proof: how far above the lower end, and how much fill to give up.
struct Attempt {
  double width, drop;
};

/// The upper end, by the cheapest certificate that is close enough, else by the best of those tried.
void solve_above(const Sides& sides, const ScalarWeights& weights, const IntervalOptions& options,
                 StepInterval& interval) {
  const auto take = [&](double bound, const char* method) {
    if (bound < interval.lambda_upper) interval.lambda_upper = bound, interval.method_upper = method;
    return interval.lambda_upper <= interval.lambda_lower * (1 + options.width);
  };
  interval.lambda_upper = INFINITY;
  SplittingWeights splitting{weights.t, {}, {}};
  if (take(splitting_bound(sides, {.matrix_sweeps = 0}, &splitting).value, "contact splitting")) return;
  const double w = options.width;
  for (const auto [width, drop] : {Attempt{w, 1e-3}, {w, 2e-4}, {4 * w, 2e-4}, {16 * w, 2e-4}}) {
    const double sigma = interval.lambda_lower * (1 + width);
    if (sigma >= interval.lambda_upper) break;
    const auto patch = stiff_patch(sides, weights.ranges, sigma);
    if (!factorise_below(sides, weights.t, patch, sigma, drop).below) continue;
    take(sigma, "incomplete Cholesky of the stiff patches");
    return;
  }
  take(collatz_bound(sides.network()).value, "block Collatz-Wielandt");
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

StepInterval step_interval(const Network& network, const IntervalOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  StepInterval interval;
  if (network.springs.empty()) {
    interval.method_lower = interval.method_upper = "no springs";
  } else if (total_dofs(network) <= options.dense_limit) {
    solve_densely(network, interval);
  } else {
    const Sides sides(network);
    ScalarWeights weights = sweep_scalars(sides, {});
    if (weights.known > 0) solve_below(sides, weights, options, interval);
    if (weights.known > 0) solve_above(sides, weights, options, interval);
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
