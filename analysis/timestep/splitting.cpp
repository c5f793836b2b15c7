#include "timestep/splitting.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "timestep/matrix_weights.hpp"
#include "timestep/scalar_weights.hpp"

namespace eg {
namespace {

/// Matrix sweeps at rising exponents, as long as they help; leaves the best weights met and their ranges.
int sweep_matrices(const SplittingOptions& options, WeightedContacts& contacts, BlockRanges& ranges) {
  const double target = options.lower_bound * (1 + options.close_enough);
  const auto maximum = [&] { return *std::max_element(ranges.low.begin(), ranges.low.end()); };
  SplittingWeights best = contacts.weights();
  BlockRanges best_ranges = ranges;
  double least = maximum();
  int sweeps = 0;
  for (int squarings = 3; squarings <= 11 && least > target; ++squarings) {
    contacts.make_matrices(ranges.low, options.hot);
    for (int sweep = 0; sweep < options.matrix_sweeps; ++sweep) contacts.sweep(squarings);
    sweeps += options.matrix_sweeps;
    contacts.update(ranges);
    if (const double now = maximum(); now < least) least = now, best = contacts.weights(), best_ranges = ranges;
  }
  contacts.set_weights(std::move(best));
  ranges = std::move(best_ranges);
  return sweeps;
}

}  // namespace

SplittingBound splitting_bound(const Network& network, const SplittingOptions& options, SplittingWeights* weights) {
  return splitting_bound(Sides(network), options, weights);
}

SplittingBound splitting_bound(const Sides& sides, const SplittingOptions& options, SplittingWeights* weights) {
  if (sides.size() == 0) return {};
  SplittingWeights start;
  BlockRanges ranges(sides.size());
  int scalar_sweeps = 0, matrix_sweeps = 0;
  if (weights && weights->scalar.size() == sides.network().springs.size()) {
    start = *weights;
    std::vector<Index> all(sides.size());
    std::iota(all.begin(), all.end(), Index{0});
    block_ranges(sides, start.scalar, all, ranges);
  } else {
    auto scalars = sweep_scalars(sides, {options.scalar_sweeps, options.lower_bound * (1 + options.close_enough)});
    start.scalar = std::move(scalars.t);
    ranges = std::move(scalars.ranges);
    scalar_sweeps = scalars.sweeps;
  }
  WeightedContacts contacts(sides, std::move(start));
  contacts.update(ranges);
  if (options.matrix_sweeps > 0) matrix_sweeps = sweep_matrices(options, contacts, ranges);
  SplittingBound bound = contacts.bound(ranges);
  bound.scalar_sweeps = scalar_sweeps;
  bound.matrix_sweeps = matrix_sweeps;
  if (weights) *weights = contacts.weights();
  return bound;
}

}  // namespace eg
