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
  /// Σ w|kn − kt|, Σ w kt δ and, times what n may turn until the next check, Σ w|kn − kt| and Σ w kt; then Σ k of what
  /// only turns the grain [N m], and that times what n may turn.
  Double8 play{};
};

/// Eight contacts as both of their grains take them in.
struct EightContacts {
  Double8 first[8], second[8];  ///< as in BlockSums at weight 1, with arms of 1 m, as grain j has them
  Double4 play[8];              ///< first half of GrainSums::play at weight 1
};
EG_INLINE void add_contact(GrainSums& grain, const EightContacts& c, std::size_t k, double w, double arm) {
  const double f = w * arm, h = f * arm;  // the arm of grain i counts as negative
  grain.block.first += c.first[k] * Double8{w, w, w, w, w, w, w, f};
  grain.block.second += c.second[k] * Double8{h, h, h, h, h, h, f, f};
  grain.play += join(c.play[k] * w, Double4{});
}

/// Everything that is known of λmax(S_i) of every grain from its sums of at most so many terms.
void bound_grains(const State& state, std::span<const GrainSums> rows, std::size_t terms, BlockRanges& ranges,
                  std::vector<GrainPlay>& plays);

/// S_i of one grain.
Block block_of(const State& state, Index grain, const GrainSums& row);

}  // namespace eg
