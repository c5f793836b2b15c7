#include "timestep/block_ranges.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "timestep/block_sums.hpp"

namespace eg {
namespace {

EG_INLINE BlockSums sum_sides(const Sides& sides, std::span<const double> t, Index grain) {
  BlockSums sums;
  for (const Side& side : sides.of(grain)) {
    double w = 1;
    if (!t.empty() && side.role != Side::Role::alone)
      w += side.role == Side::Role::first ? t[side.spring] : 1 / t[side.spring];
    add_side(sums, sides.network().springs[side.spring], side, w);
  }
  return sums;
}

EG_INLINE void eight_ranges(const Sides& sides, std::span<const double> t, std::span<const Index> grains,
                            BlockRanges& ranges) {
  std::array<BlockSums, 8> sums;
  std::array<std::array<double, 8>, 6> scale{};
  for (std::size_t k = 0; k < grains.size(); ++k) {
    sums[k] = sum_sides(sides, t, grains[k]);
    const auto d = sides.scale(grains[k]);
    for (int c = 0; c < 6; ++c) scale[static_cast<std::size_t>(c)][k] = d(c);
  }
  std::array<const BlockSums*, 8> rows;
  for (std::size_t k = 0; k < 8; ++k) rows[k] = &sums[k];
  std::array<Batch, 6> d;
  for (std::size_t c = 0; c < 6; ++c) d[c] = load_lanes(scale[c].data());
  const EightRanges range = range_of(scaled_blocks(columns_of(rows), d));
  for (std::size_t k = 0; k < grains.size(); ++k) {
    const double terms = static_cast<double>(sides.of(grains[k]).size());
    ranges.low[grains[k]] = range.low[k];
    ranges.high[grains[k]] = range.high[k] * (1 + 8 * terms * std::numeric_limits<double>::epsilon());
  }
}

}  // namespace

void block_ranges(const Sides& sides, std::span<const double> t, std::span<const Index> grains, BlockRanges& ranges) {
  const auto groups = static_cast<std::ptrdiff_t>((grains.size() + 7) / 8);
#pragma omp parallel for schedule(static) if (groups > 256)
  for (std::ptrdiff_t group = 0; group < groups; ++group) {
    const std::size_t first = 8 * static_cast<std::size_t>(group);
    eight_ranges(sides, t, grains.subspan(first, std::min<std::size_t>(8, grains.size() - first)), ranges);
  }
}

Block scalar_block(const Sides& sides, std::span<const double> t, Index grain) {
  return sides.block(grain, [&](const Side& side) -> Eigen::Matrix3d {
    const Spring& s = sides.network().springs[side.spring];
    double w = 1;
    if (side.role != Side::Role::alone) w += side.role == Side::Role::first ? t[side.spring] : 1 / t[side.spring];
    const Eigen::Vector3d n(s.n.x, s.n.y, s.n.z);
    return w * (s.tangential * Eigen::Matrix3d::Identity() + (s.normal - s.tangential) * n * n.transpose());
  });
}

}  // namespace eg
