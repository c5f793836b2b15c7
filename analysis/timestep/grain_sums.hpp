#pragma once
// All that a look at the contacts adds up of each grain: its block S_i, and how much that may change (play.hpp).
#include <span>
#include <vector>

#include "base/aligned.hpp"
#include "timestep/block_ranges.hpp"
#include "timestep/block_sums.hpp"
#include "timestep/play.hpp"

namespace eg {

struct alignas(64) GrainSums {
  BlockSums block;
  /// Σ w kt δ and, times what n may turn until the next check, Σ w|kn − kt|, Σ w kt and Σ k of what only turns the
  /// grain [N m].
  Double4 play{};
};

/// Eight contacts as both of their grains take them in.
struct EightContacts {
  Double8 first[8], second[8];  ///< as in BlockSums at weight 1, with arms of 1 m, as grain j has them
  Double4 play[8];              ///< as in GrainSums at weight 1
};
EG_INLINE void add_contact(GrainSums& grain, const EightContacts& c, std::size_t k, double w, double arm) {
  const double f = w * arm, h = f * arm;  // the arm of grain i counts as negative
  grain.block.first += c.first[k] * Double8{w, w, w, w, w, w, w, f};
  grain.block.second += c.second[k] * Double8{h, h, h, h, h, h, f, f};
  grain.play += c.play[k] * w;
}

/// Bounds of the grains [first, end), end − first ≤ 8, from their sums of at most so many terms [1/s²]: of λmax(S_i) as
/// the contacts are, to some 3 % but for grains far below `cold`, and of what may come to it until the next check.
struct EightBounds {
  Batch high, play;
};
EightBounds bound_eight(const State& state, std::span<const GrainSums> rows, std::size_t first, std::size_t end,
                        std::size_t terms, double cold);

/// S_i of one grain.
Block block_of(const State& state, std::span<const GrainSums> rows, Index grain);

}  // namespace eg
