#include "timestep/scalar_weights.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace eg {
namespace {

constexpr double widest = 1096.6;  // e⁷: beyond it a contact is one-sided anyway
constexpr double warm = 0.85;      // of the maximum: grains that a warm start still works on

/// t ← t λ_j / λ_i
void even_out(const Spring& s, const std::vector<double>& lambda, double& t) {
  const double next = t * (lambda[s.j] / lambda[s.i]);
  if (std::isfinite(next)) t = std::clamp(next, 1 / widest, widest);
}

/// The contacts of hot grains, and all grains that these touch. Only grows.
class HotSet {
 public:
  /// Grains that cannot be proved below `least` are hot.
  HotSet(const Sides& sides, double least) : sides_(sides), least_(least), mark_(sides.size(), 0) {}

  /// Looks at the grains listed in `from`.
  void add(const BlockRanges& ranges, const std::vector<Index>& from) {
    std::vector<Index> fresh;
    for (const Index g : from)
      if (mark_[g] != hot && ranges.high[g] >= least_ && least_ > 0) fresh.push_back(g);
    for (const Index g : fresh) heat(g);
  }
  std::vector<Index> springs, grains;

 private:
  enum : char { cold, neighbour, hot };

  void heat(Index g) {
    if (mark_[g] == cold) grains.push_back(g);
    mark_[g] = hot;
    for (const Side& side : sides_.of(g)) {
      if (side.role == Side::Role::alone) continue;
      const Spring& s = sides_.network().springs[side.spring];
      if (!(s.normal > 0 || s.tangential > 0)) continue;
      const Index other = s.i == g ? s.j : s.i;
      if (mark_[other] != hot) springs.push_back(side.spring);
      if (mark_[other] == cold) mark_[other] = neighbour, grains.push_back(other);
    }
  }

  const Sides& sides_;
  double least_;
  std::vector<char> mark_;
};

double largest(const std::vector<double>& values, const std::vector<Index>& grains) {
  double maximum = 0;
  for (const Index g : grains) maximum = std::max(maximum, values[g]);
  return maximum;
}

/// Sweeps over the hot set, which takes in what the sweeps heat up; leaves the best weights met and their ranges.
void sweep_hot(const Sides& sides, const ScalarSweepOptions& options, HotSet& set, ScalarWeights& weights) {
  const auto& springs = sides.network().springs;
  std::vector<double> best;
  double least = INFINITY;
  for (int idle = 0;; ++weights.sweeps) {
    const double now = largest(weights.ranges.low, set.grains);
    idle = now < least * (1 - 1e-3) ? 0 : idle + 1;
    set.add(weights.ranges, std::vector(set.grains));
    const std::size_t kept = now < least ? 0 : best.size();
    best.resize(set.springs.size());
    for (std::size_t k = kept; k < best.size(); ++k) best[k] = weights.t[set.springs[k]];
    least = std::min(least, now);
    if (weights.sweeps >= options.most || idle > 4 || least <= options.target) break;
    for (const Index c : set.springs) even_out(springs[c], weights.ranges.low, weights.t[c]);
    block_ranges(sides, weights.t, set.grains, weights.ranges);
  }
  for (std::size_t k = 0; k < best.size(); ++k) weights.t[set.springs[k]] = best[k];
  block_ranges(sides, weights.t, set.grains, weights.ranges);
}

std::vector<Index> all_grains(const Sides& sides) {
  std::vector<Index> all(sides.size());
  std::iota(all.begin(), all.end(), Index{0});
  return all;
}

/// Ranges of the self blocks; returns the largest lower end, rounded down.
double self_blocks(const Sides& sides, const std::vector<Index>& all, BlockRanges& ranges) {
  block_ranges(sides, {}, all, ranges);
  return largest(ranges.low, all) * (1 - 1e-12);
}

}  // namespace

double largest_self_block(const Sides& sides) {
  BlockRanges ranges(sides.size());
  return self_blocks(sides, all_grains(sides), ranges);
}

ScalarWeights sweep_scalars(const Sides& sides, const ScalarSweepOptions& options) {
  const auto& springs = sides.network().springs;
  ScalarWeights weights{std::vector(springs.size(), 1.0), BlockRanges(sides.size()), 0, 0};
  const std::vector<Index> all = all_grains(sides);
  if (options.start.empty()) {
    weights.known = self_blocks(sides, all, weights.ranges);
    if (options.most > 0)
      for (std::size_t c = 0; c < springs.size(); ++c)
        if (sides.is_split(c)) even_out(springs[c], weights.ranges.low, weights.t[c]);
    weights.sweeps = std::min(options.most, 1);
  } else {
    weights.t.assign(options.start.begin(), options.start.end());
  }
  block_ranges(sides, weights.t, all, weights.ranges);
  HotSet set(sides, options.start.empty() ? weights.known : warm * largest(weights.ranges.low, all));
  set.add(weights.ranges, all);
  sweep_hot(sides, options, set, weights);
  return weights;
}

}  // namespace eg
