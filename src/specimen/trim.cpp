#include "specimen/trim.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace eg {

namespace {

/// Whether the grain lies inside, its outermost point or its centre; what touches from inside is in.
bool keeps(const TrimSpec& t, int dimension, const Vec3& x, double radius) {
  const double room = t.keep == TrimSpec::Keep::whole ? radius * (1 - 1e-9) : 0;
  for (int k = 0; k < dimension; ++k)
    if (x[k] - room < t.low[k] || x[k] + room > t.high[k]) return false;
  if (t.shape == TrimSpec::Shape::box) return true;
  const int a = (t.axis + 1) % 3, b = (t.axis + 2) % 3;
  const double distance = std::hypot(x[a] - t.centre[a], x[b] - t.centre[b]);
  return distance + room <= t.radius && distance - room >= t.inner_radius;
}

}  // namespace

Packing trimmed(const Scene& scene, const Packing& packing) {
  const TrimSpec& t = *scene.specimen.trim;
  Packing kept;
  kept.box = packing.box, kept.dimension = packing.dimension;
  Vec3 low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};
  for (std::size_t i = 0; i < packing.size(); ++i) {
    const double r = packing.radius[i];
    if (!keeps(t, packing.dimension, packing.position[i], r)) continue;
    kept.position.push_back(packing.position[i]);
    kept.radius.push_back(r);
    for (int k = 0; k < packing.dimension; ++k) {
      low[k] = std::min(low[k], packing.position[i][k] - r);
      high[k] = std::max(high[k], packing.position[i][k] + r);
    }
  }
  if (kept.size() == 0)
    throw input_error(scene.file, 0, "specimen.trim", fmt::format("keeps none of the {} grains", packing.size()),
                      t.keep == TrimSpec::Keep::whole ? "make it larger, move it, or set keep = \"centre\""
                                                      : "make it larger or move it");
  Vec3 corner;
  for (int k = 0; k < packing.dimension; ++k) {
    // a cut beyond the source's box and grains leaves the sides of that
    corner[k] = std::isfinite(t.low[k]) ? std::max(t.low[k], std::min(0.0, low[k])) : low[k];
    const double end = std::isfinite(t.high[k]) ? std::min(t.high[k], std::max(packing.box[k], high[k])) : high[k];
    kept.box[k] = end - corner[k];
  }
  for (auto& x : kept.position) x -= corner;
  return kept;
}

}  // namespace eg
