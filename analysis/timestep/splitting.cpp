#include "timestep/splitting.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "timestep/block_power.hpp"
#include "timestep/matrix_weights.hpp"
#include "timestep/scalar_weights.hpp"

namespace eg {
namespace {

/// Ranges of the blocks that have matrices in them; block_ranges() knows the rest.
void matrix_ranges(const WeightedContacts& contacts, BlockRanges& ranges) {
  const std::vector<Index> grains = contacts.matrix_grains();
  const auto size = static_cast<std::ptrdiff_t>(grains.size());
#pragma omp parallel for schedule(static) if (size > 256)
  for (std::ptrdiff_t k = 0; k < size; ++k) {
    const Index g = grains[static_cast<std::size_t>(k)];
    const Block block = contacts.block(g);
    BlockPower power(block);
    for (int s = 0; s < 5; ++s) power.square();
    ranges.low[g] = power.trace_ratio(block);
    ranges.high[g] = power.trace_root() * (1 + 1e-10);
  }
}

/// The greatest block_upper_bound() of all grains, and whose it is.
SplittingBound block_maximum(const Sides& sides, const WeightedContacts& contacts, const BlockRanges& ranges) {
  SplittingBound maximum;
  std::vector<Index> grains;
  const double least = ranges.low.empty() ? 0 : *std::max_element(ranges.low.begin(), ranges.low.end());
  for (std::size_t g = 0; g < sides.size(); ++g)
    if (!sides.of(g).empty() && ranges.high[g] >= least) grains.push_back(static_cast<Index>(g));
  std::stable_sort(grains.begin(), grains.end(), [&](Index a, Index b) { return ranges.low[a] > ranges.low[b]; });
  for (const Index g : grains) {
    const std::size_t terms = sides.of(g).size();
    if (ranges.high[g] < maximum.value) continue;
    const Block block = contacts.block(g);
    if (block_is_below(block, terms, maximum.value)) continue;
    const double bound = block_upper_bound(block, terms);
    if (bound > maximum.value) maximum.value = bound, maximum.grain = g;
  }
  return maximum;
}

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
    matrix_ranges(contacts, ranges);
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
  matrix_ranges(contacts, ranges);
  if (options.matrix_sweeps > 0) matrix_sweeps = sweep_matrices(options, contacts, ranges);
  SplittingBound bound = block_maximum(sides, contacts, ranges);
  bound.scalar_sweeps = scalar_sweeps;
  bound.matrix_sweeps = matrix_sweeps;
  if (weights) *weights = contacts.weights();
  return bound;
}

}  // namespace eg
