#include "timestep/grain_sums.hpp"

#include <algorithm>
#include <limits>

#include "timestep/outgrown.hpp"

namespace eg {
namespace {

/// M^−½ of a grain, 0 for what is not a degree of freedom.
std::array<double, 6> scale_of(const State& state, Index g) {
  const Inertia inertia = inertia_of(state.grains, g);
  const double shift = std::sqrt(inertia.inverse_mass), turn = std::sqrt(inertia.inverse_inertia);
  if (state.dimension == 2) return {shift, shift, 0, 0, 0, turn};
  return {shift, shift, shift, turn, turn, turn};
}

/// play() is linear in |kn − kt| and kt but for its root, which is not above that of either alone, added up.
GrainPlay play_of(const GrainSums& sums, const Inertia& g) {
  const double turn = g.radius * g.radius * g.inverse_inertia,
               mixed = g.radius * std::sqrt(g.inverse_mass * g.inverse_inertia);
  const double shear = 0.5 * turn + std::sqrt(0.25 * turn * turn + mixed * mixed);
  const auto of = [&](double stretch, double kt, double couple) {
    return (stretch * g.inverse_mass + kt * shear + couple * g.inverse_inertia) * sum_rounding;
  };
  const double arm = (0.5 * mixed + turn) / g.radius * sums.play[1] * sum_rounding;
  GrainPlay play;
  play.turn = of(sums.play[0], sums.block.first[6], sums.play[4]);
  play.counted = arm + play.turn * direction_error;
  play.ahead = arm + of(sums.play[2], sums.play[3], sums.play[5]);
  return play;
}

/// S_i of eight grains from `first` on; the last one again where there are fewer.
EG_INLINE Triangle eight_blocks(const State& state, std::span<const GrainSums> rows, std::size_t first,
                                std::size_t last) {
  std::array<const BlockSums*, 8> sums;
  std::array<std::array<double, 8>, 6> scale;
  for (std::size_t k = 0; k < 8; ++k) {
    const std::size_t g = std::min(first + k, last);
    sums[k] = &rows[g].block;
    const auto d = scale_of(state, static_cast<Index>(g));
    for (std::size_t c = 0; c < 6; ++c) scale[c][k] = d[c];
  }
  std::array<Batch, 6> d;
  for (std::size_t c = 0; c < 6; ++c) d[c] = load_lanes(scale[c].data());
  return scaled_blocks(columns_of(sums), d);
}

}  // namespace

void bound_grains(const State& state, std::span<const GrainSums> rows, std::size_t terms, BlockRanges& ranges,
                  std::vector<GrainPlay>& plays) {
  const std::size_t grains = state.grains.size();
  plays.resize(grains), ranges.low.resize(grains), ranges.high.resize(grains);
  const double rounding = 1 + 32 * static_cast<double>(terms) * std::numeric_limits<double>::epsilon();
  const auto groups = static_cast<std::ptrdiff_t>((grains + 7) / 8);
#pragma omp parallel for schedule(static) if (groups > 256)
  for (std::ptrdiff_t group = 0; group < groups; ++group) {
    const std::size_t first = 8 * static_cast<std::size_t>(group), end = std::min(first + 8, grains);
    const EightRanges range = range_of(eight_blocks(state, rows, first, end - 1));
    for (std::size_t g = first; g < end; ++g) {
      ranges.low[g] = range.low[g - first], ranges.high[g] = range.high[g - first] * rounding;
      plays[g] = play_of(rows[g], inertia_of(state.grains, static_cast<Index>(g)));
    }
  }
}

Block block_of(const State& state, Index grain, const GrainSums& row) {
  const Triangle lower = [&] {
    std::array<const BlockSums*, 8> sums;
    sums.fill(&row.block);
    std::array<Batch, 6> d;
    const auto scale = scale_of(state, grain);
    for (std::size_t c = 0; c < 6; ++c) d[c] = Batch(scale[c]);
    return scaled_blocks(columns_of(sums), d);
  }();
  Block block;
  for (std::size_t r = 0; r < 6; ++r)
    for (std::size_t c = 0; c < 6; ++c)
      block(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) = lower(r, c)[0];
  return block;
}

}  // namespace eg
