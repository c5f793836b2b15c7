#include "timestep/splitting.hpp"

#include <algorithm>
#include <cmath>

#include "timestep/block_power.hpp"
#include "timestep/matrix_weights.hpp"

namespace eg {
namespace {

constexpr double widest_log = 7;  // T between e^−7 and e^7: beyond it a contact is one-sided anyway

/// λmax(S_i), a grain: exact for those that may be the largest, a few per cent low for the rest.
struct Estimates {
  std::vector<double> grain;
  double maximum = 0;
};

Estimates estimate(const Sides& sides, const WeightedContacts& contacts) {
  Estimates estimates{std::vector<double>(sides.size(), 0.0)};
  auto& lambda = estimates.grain;
  const auto size = static_cast<std::ptrdiff_t>(sides.size());
#pragma omp parallel for schedule(static) if (size > 256)
  for (std::ptrdiff_t g = 0; g < size; ++g) {
    const auto grain = static_cast<std::size_t>(g);
    if (sides.of(grain).empty()) continue;
    const Block block = contacts.block(grain);
    BlockPower power(block);
    for (int k = 0; k < 4; ++k) power.square();
    lambda[grain] = power.trace_ratio(block);
  }
  if (size == 0) return estimates;
  // The ratio of traces at p = 16 is at most 5 % low, whatever the six eigenvalues are.
  const double close = 0.95 * *std::max_element(lambda.begin(), lambda.end());
#pragma omp parallel for schedule(static) if (size > 256)
  for (std::ptrdiff_t g = 0; g < size; ++g) {
    const auto grain = static_cast<std::size_t>(g);
    if (lambda[grain] < close || sides.of(grain).empty()) continue;
    lambda[grain] = block_upper_bound(contacts.block(grain), sides.of(grain).size());
  }
  estimates.maximum = *std::max_element(lambda.begin(), lambda.end());
  return estimates;
}

/// t ← t λ_j / λ_i for every contact: evens out the two grains.
void even_out(const Sides& sides, const std::vector<double>& lambda, std::vector<double>& log_t) {
  const auto& springs = sides.network().springs;
  for (std::size_t c = 0; c < springs.size(); ++c)
    if (sides.is_split(c)) {
      const double change = std::log(lambda[springs[c].j] / lambda[springs[c].i]);
      if (std::isfinite(change)) log_t[c] = std::clamp(log_t[c] + change, -widest_log, widest_log);
    }
}

/// Scalar sweeps from the weights given; leaves the best ones met. Returns the estimate that belongs to them.
double sweep_scalars(const Sides& sides, const SplittingOptions& options, WeightedContacts& contacts,
                     SplittingBound& bound) {
  const double target = options.lower_bound * (1 + options.close_enough);
  std::vector<double> best = contacts.weights().log_scalar;
  double least = INFINITY;
  int idle = 0;
  for (int sweep = 0;; ++sweep) {
    const Estimates lambda = estimate(sides, contacts);
    if (sweep == 0) bound.plain = lambda.maximum;
    idle = lambda.maximum < least * (1 - 1e-3) ? 0 : idle + 1;
    if (lambda.maximum < least) least = lambda.maximum, best = contacts.weights().log_scalar;
    if (least <= target || idle >= 4 || sweep == options.scalar_sweeps) break;
    even_out(sides, lambda.grain, contacts.weights().log_scalar);
    ++bound.scalar_sweeps;
  }
  contacts.weights().log_scalar = best;
  return least;
}

/// Matrix sweeps at rising exponents, as long as they help; leaves the best weights met.
void sweep_matrices(const Sides& sides, const SplittingOptions& options, double least, WeightedContacts& contacts,
                    SplittingBound& bound) {
  const double target = options.lower_bound * (1 + options.close_enough);
  SplittingWeights best = contacts.weights();
  for (int squarings = 3; squarings <= 11 && least > target; ++squarings) {
    contacts.make_matrices(estimate(sides, contacts).grain, options.hot);
    for (int sweep = 0; sweep < options.matrix_sweeps; ++sweep) contacts.sweep(squarings);
    bound.matrix_sweeps += options.matrix_sweeps;
    const double now = estimate(sides, contacts).maximum;
    if (now < least) least = now, best = contacts.weights();
  }
  contacts.set_weights(best);
}

}  // namespace

SplittingBound splitting_bound(const Network& network, const SplittingOptions& options, SplittingWeights* weights) {
  const Sides sides(network);
  const bool warm = weights && weights->log_scalar.size() == network.springs.size();
  WeightedContacts contacts(sides,
                            warm ? *weights : SplittingWeights{std::vector(network.springs.size(), 0.0), {}, {}});
  SplittingBound bound;
  double least = INFINITY;
  if (contacts.weights().matrix_spring.empty())
    least = sweep_scalars(sides, options, contacts, bound);
  else
    least = estimate(sides, contacts).maximum;
  if (options.matrix_sweeps > 0) sweep_matrices(sides, options, least, contacts, bound);
  const auto maximum = block_maximum(sides, [&](std::size_t grain) { return contacts.block(grain); });
  bound.value = maximum.value;
  bound.grain = maximum.grain;
  if (weights) *weights = contacts.weights();
  return bound;
}

}  // namespace eg
