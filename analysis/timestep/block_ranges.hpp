#pragma once
#include <span>
#include <vector>

#include "timestep/sides.hpp"

namespace eg {

/// What is known of λmax(S_i) of every grain [1/s²], low ≤ λmax(S_i) ≤ high; `high` is proved, round-off included.
struct BlockRanges {
  std::vector<double> low, high;  ///< high/low is at most 1.12, mostly near 1.03

  explicit BlockRanges(std::size_t grains) : low(grains, 0.0), high(grains, 0.0) {}
};

/// Fills the ranges of the `grains` named, eight at a time, for S_i = Σ Aᵀ (1 + t^±1) A with a scalar t > 0 a spring;
/// an empty `t` asks for the self blocks Σ AᵀA. A few tens of nanoseconds a contact.
///
/// low = tr S^17 / tr S^16 and high = (tr S^32)^(1/32): any matrix of six eigenvalues has λmax between them.
void block_ranges(const Sides& sides, std::span<const double> t, std::span<const Index> grains, BlockRanges& ranges);

/// S_i of one grain.
Block scalar_block(const Sides& sides, std::span<const double> t, Index grain);

}  // namespace eg
