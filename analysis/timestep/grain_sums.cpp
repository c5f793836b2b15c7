#include "timestep/grain_sums.hpp"

#include <algorithm>
#include <limits>

namespace eg {
namespace {

/// Eight grains, the last one again where there are fewer.
struct Eight {
  std::array<const GrainSums*, 8> sums;
  Batch inverse_mass, inverse_inertia, radius;

  Eight(const State& state, std::span<const GrainSums> rows, std::size_t first, std::size_t last) {
    for (std::size_t k = 0; k < 8; ++k) {
      const std::size_t g = std::min(first + k, last);
      const Inertia inertia = inertia_of(state.grains, static_cast<Index>(g));
      sums[k] = &rows[g];
      inverse_mass.v[k] = inertia.inverse_mass, inverse_inertia.v[k] = inertia.inverse_inertia;
      radius.v[k] = inertia.radius;
    }
  }

  std::array<Batch, 16> columns() const {
    std::array<const BlockSums*, 8> block;
    for (std::size_t k = 0; k < 8; ++k) block[k] = &sums[k]->block;
    return columns_of(block);
  }
  Triangle blocks(const std::array<Batch, 16>& columns, int dimension) const {
    const Batch shift = sqrt(inverse_mass), turn = sqrt(inverse_inertia), none(0.0);
    if (dimension == 2) return scaled_blocks(columns, {shift, shift, none, none, none, turn});
    return scaled_blocks(columns, {shift, shift, shift, turn, turn, turn});
  }

  /// play() is linear in |kn − kt| and kt but for its root, which is not above that of either alone, added up.
  Batch plays() const {
    const Batch half(0.5), turn = radius * radius * inverse_inertia,
                           mixed = radius * sqrt(inverse_mass * inverse_inertia);
    const Batch shear = half * turn + sqrt(Batch(0.25) * turn * turn + mixed * mixed);
    const auto pair = [&](std::size_t k) { return join(sums[k]->play, sums[k + 4]->play); };
    const QuadColumns of = transpose_rows({pair(0), pair(1), pair(2), pair(3)});
    return ((half * mixed + turn) / radius * of.x + of.y * inverse_mass + of.z * shear + of.w * inverse_inertia) *
           Batch(sum_rounding);
  }
};

}  // namespace

EightBounds bound_eight(const State& state, std::span<const GrainSums> rows, std::size_t first, std::size_t end,
                        std::size_t terms, double cold) {
  const Eight eight(state, rows, first, end - 1);
  const auto columns = eight.columns();
  Batch high = rough_bound(columns, eight.inverse_mass, eight.inverse_inertia);  // plane motion is part of this
  if (any(high > Batch(cold))) high = range_of(eight.blocks(columns, state.dimension)).high;
  const double rounding = 1 + 32 * static_cast<double>(terms) * std::numeric_limits<double>::epsilon();
  return {high * Batch(rounding), eight.plays()};
}

Block block_of(const State& state, std::span<const GrainSums> rows, Index grain) {
  const Eight eight(state, rows, grain, grain);
  const Triangle lower = eight.blocks(eight.columns(), state.dimension);
  Block block;
  for (std::size_t r = 0; r < 6; ++r)
    for (std::size_t c = 0; c < 6; ++c)
      block(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) = lower(r, c)[0];
  return block;
}

}  // namespace eg
