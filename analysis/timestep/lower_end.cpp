#include "timestep/lower_end.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "assembly/apply.hpp"
#include "assembly/stiffness.hpp"
#include "eigen/lanczos.hpp"
#include "timestep/patch.hpp"

namespace eg {
namespace {

// Round-off of a Rayleigh quotient: sums of up to 4096/8 terms in eight lanes, then of the pieces (eigen/vectors.cpp),
// and of some tens of contacts a grain: below 1e4 ε for any network that fits a machine.
constexpr double quotient_error = 2e-12;

constexpr int shells = 3;
constexpr double crowded = 0.4;     // share of the grains from which on a patch is no longer local
constexpr std::size_t scouts = 16;  // grains that the first look is for
constexpr double caution = 0.99;    // of what it found

EigenResult lanczos_on(const Network& network, LanczosOptions options, int steps, double tolerance) {
  const StiffnessOperator a(network, StiffnessOperator::Scaling::mass);
  options.min_steps = steps, options.tolerance = tolerance;
  if (tolerance >= 1) options.max_steps = steps, options.max_restarts = 0;
  return lanczos_largest(a, options);
}

/// A first value, a few per cent low at most, from the surroundings of the grains that splitting finds the stiffest.
double scout(const Sides& sides, const BlockRanges& ranges, StepInterval& interval) {
  std::vector<Index> grains;
  for (std::size_t g = 0; g < sides.size(); ++g)
    if (!sides.of(g).empty()) grains.push_back(static_cast<Index>(g));
  const std::size_t count = std::min(scouts, grains.size());
  std::partial_sort(
      grains.begin(), grains.begin() + static_cast<std::ptrdiff_t>(count), grains.end(),
      [&](Index a, Index b) { return ranges.low[a] != ranges.low[b] ? ranges.low[a] > ranges.low[b] : a < b; });
  grains.resize(count);
  const EigenResult top = lanczos_on(patch_network(sides, grow_patch(sides, std::move(grains), 1)), {}, 12, 1);
  interval.products += top.products;
  return caution * top.value;
}

std::vector<double> spread(const Network& whole, std::span<const Index> patch, std::span<const double> mode) {
  const auto width = static_cast<std::size_t>(whole.dofs_per_grain());
  std::vector<double> all(total_dofs(whole), 0.0);
  for (std::size_t k = 0; k < patch.size(); ++k) std::copy_n(&mode[k * width], width, &all[patch[k] * width]);
  return all;
}

}  // namespace

void find_lower_end(const Sides& sides, const ScalarWeights& weights, const IntervalOptions& options,
                    StepInterval& interval) {
  const Network& whole = sides.network();
  const double known = std::max(weights.known, scout(sides, weights.ranges, interval));
  const auto patch = stiff_patch(sides, weights.ranges, known, shells);
  const bool local = static_cast<double>(patch.size()) <= crowded * static_cast<double>(sides.size());
  LanczosOptions lanczos;
  lanczos.seed = options.seed;
  EigenResult top = lanczos_on(local ? patch_network(sides, patch) : whole, lanczos, 60, options.tolerance);
  interval.lambda_lower = top.value * (1 - quotient_error);
  interval.method_lower = local ? "Lanczos on the stiffest grains" : top.method;
  interval.residual = top.residual;
  interval.products += top.products;
  interval.mode = local ? spread(whole, patch, top.vector) : std::move(top.vector);
}

}  // namespace eg
