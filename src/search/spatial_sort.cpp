#include "search/spatial_sort.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace eg {
namespace {

/// Spreads the low 20 bits of v to every third bit (Morton 1966).
std::uint64_t spread(std::uint64_t v) {
  v = (v | v << 32) & 0x001f00000000ffffULL;
  v = (v | v << 16) & 0x001f0000ff0000ffULL;
  v = (v | v << 8) & 0x100f00f00f00f00fULL;
  v = (v | v << 4) & 0x10c30c30c30c30c3ULL;
  return (v | v << 2) & 0x1249249249249249ULL;
}

template <class T>
void permute(std::vector<T>& values, const std::vector<Index>& order) {
  if (values.empty()) return;
  std::vector<T> sorted(values.size());
  for (std::size_t k = 0; k < order.size(); ++k) sorted[k] = values[order[k]];
  values = std::move(sorted);
}

}  // namespace

void sort_grains(State& state) {
  auto& g = state.grains;
  const std::size_t n = g.size();
  Vec3 low{INFINITY, INFINITY, INFINITY}, high = -low;
  for (const auto& p : g.position)
    for (int k = 0; k < 3; ++k) low[k] = std::min(low[k], p.vec()[k]), high[k] = std::max(high[k], p.vec()[k]);
  const double extent = std::max({high.x - low.x, high.y - low.y, high.z - low.z, 1e-300});
  // cells of about one grain: finer cells would not bring neighbours closer, only make the order jumpy
  const double cells = std::min(1e6, std::cbrt(static_cast<double>(n)) + 1);
  std::vector<std::uint64_t> key(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 s = (g.position[i].vec() - low) * (cells / extent);
    key[i] = spread(static_cast<std::uint64_t>(s.x)) | spread(static_cast<std::uint64_t>(s.y)) << 1 |
             spread(static_cast<std::uint64_t>(s.z)) << 2;
  }
  std::vector<Index> order(n), rank(n);
  std::iota(order.begin(), order.end(), Index{0});
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return key[a] < key[b]; });
  for (std::size_t k = 0; k < n; ++k) rank[order[k]] = static_cast<Index>(k);
  permute(g.position, order), permute(g.velocity, order), permute(g.spin, order);
  permute(g.id, order), permute(g.material, order), permute(state.list.reference, order);

  auto& c = state.contacts;
  for (std::size_t k = 0; k < c.size(); ++k) {
    const bool padding = c.is_padding(k);
    c.i[k] = rank[c.i[k]], c.j[k] = rank[c.j[k]];
    if (padding || c.i[k] <= c.j[k]) continue;
    std::swap(c.i[k], c.j[k]);  // the other side is i now: the image turns round and vectors change sign
    if (!c.image.empty()) c.image[k] = static_cast<std::uint8_t>(26 - c.image[k]);
    for (std::size_t h = 0; h < c.history_size; ++h)
      if (h < 3 * c.history_vectors || h + 3 * c.tail_vectors >= c.history_size)
        c.history_at(k, h) = -c.history_at(k, h);
  }
  for (auto& w : state.wall_contacts) w.grain = rank[w.grain];
  for (auto& g : state.glued) g.grain = rank[g.grain];
  std::ranges::sort(state.glued, {}, &GluedGrain::grain);
  for (auto& f : state.applied) f.grain = rank[f.grain];
  std::ranges::sort(state.applied, {}, &AppliedForce::grain);
}

}  // namespace eg
