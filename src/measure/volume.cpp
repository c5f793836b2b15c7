#include "measure/volume.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace eg {

namespace {
constexpr double pi = std::numbers::pi;
}

double grain_volume(int dimension, double radius) {
  return dimension == 3 ? 4 * pi / 3 * radius * radius * radius : pi * radius * radius;
}

double cap_volume(int dimension, double radius, double height) {
  const double h = radius - height;  // thickness of the cap
  if (dimension == 3) return pi * h * h * (3 * radius - h) / 3;
  // r² acos(x) − x r² √(1−x²), written with the half-angle so that thin caps keep their digits
  const double angle = 4 * std::asin(std::sqrt(std::clamp(h / (2 * radius), 0.0, 1.0)));
  const double thin = angle * angle * angle / 6 * (1 - angle * angle / 20);
  return 0.5 * radius * radius * (angle < 1e-2 ? thin : angle - std::sin(angle));
}

double lens_volume(int dimension, double ri, double rj, double distance) {
  const double overlap = ri + rj - distance;
  if (overlap <= 0) return 0;
  if (distance <= std::abs(ri - rj)) return grain_volume(dimension, std::min(ri, rj));
  // thickness of either cap: δ (d + R_other − R)/(2d)
  const double hi = overlap * (distance + (rj - ri)) / (2 * distance);
  const double hj = overlap * (distance + (ri - rj)) / (2 * distance);
  return cap_volume(dimension, ri, ri - hi) + cap_volume(dimension, rj, rj - hj);
}

/// Whether both walls are there for the same grains, or one of them for all.
static bool side_by_side(const Wall& a, const Wall& b) {
  if (!a.windowed() || !b.windowed()) return true;
  const double shift = dot(b.point - a.point, a.along);
  return dot(a.along, b.along) > 1 - 1e-9 && a.low < b.high + shift && b.low + shift < a.high;
}

Extent wall_gap(const State& state, int k) {
  Extent gap;
  for (const Wall& lower : state.walls) {
    if (lower.shape != Wall::plane || lower.normal[k] != 1) continue;
    for (const Wall& upper : state.walls)
      if (upper.shape == Wall::plane && upper.normal[k] == -1 && side_by_side(lower, upper) &&
          upper.point[k] - lower.point[k] < gap.length())
        gap = {lower.point[k], upper.point[k]};
  }
  if (std::isfinite(gap.length())) return gap;
  for (const Wall& wall : state.walls) {  // nothing face to face
    if (wall.shape != Wall::plane) continue;
    if (wall.normal[k] == 1) gap.low = std::max(gap.low, wall.point[k]);
    if (wall.normal[k] == -1) gap.high = std::min(gap.high, wall.point[k]);
  }
  return gap;
}

double round_section(const State& state, const Vec3& axis) {
  double outer = 0, inner = 0, angle = 0;
  for (const Wall& wall : state.walls)
    if (wall.shape == Wall::cylinder && std::abs(dot(wall.normal, axis)) > 1 - 1e-9) {
      double& radius = wall.hollow ? outer : inner;
      radius = std::max(radius, wall.radius);
      if (wall.hollow) angle = wall.angle;
    }
  return 0.5 * angle * (outer * outer - inner * inner);
}

double specimen_volume(const State& state) {
  if (state.membrane.volume > 0) return state.membrane.volume;
  Mat3 edges = state.cell.h;
  for (int k = 0; k < state.dimension; ++k)
    if (const double gap = wall_gap(state, k).length(); std::isfinite(gap)) edges(k, k) = gap;
  for (int k = 0; k < 3; ++k) {
    Vec3 axis;
    axis[k] = 1;
    if (const double section = round_section(state, axis); section > 0) return section * edges(k, k);
  }
  return edges(0, 0) * edges(1, 1) * edges(2, 2);
}

double solid_volume(const State& state) {
  if (state.membrane.volume > 0) return state.membrane.solid;
  double sum = 0;
  for (std::size_t i = 0; i < state.grains.size(); ++i) sum += grain_volume(state.dimension, state.grains.radius(i));
  return sum;
}

double overlap_volume(const State& state, std::span<const ContactPoint> contacts) {
  double sum = 0;
  for (const auto& c : contacts) {
    const double ri = state.grains.radius(c.i);
    sum += c.j == no_index ? cap_volume(state.dimension, ri, ri - c.geometry.overlap)
                           : lens_volume(state.dimension, ri, state.grains.radius(c.j), norm(c.branch));
  }
  return sum;
}

SizeStatistics size_statistics(const State& state) {
  SizeStatistics result;
  const std::size_t count = state.grains.size();
  if (count == 0) return result;
  std::vector<double> diameter(count);
  for (std::size_t i = 0; i < count; ++i) diameter[i] = 2 * state.grains.radius(i);
  std::sort(diameter.begin(), diameter.end());
  result.smallest = diameter.front(), result.largest = diameter.back();
  double variance = 0, mass = 0;
  for (const double d : diameter) result.mean += d / static_cast<double>(count);
  for (const double d : diameter) variance += (d - result.mean) * (d - result.mean) / static_cast<double>(count);
  result.deviation = std::sqrt(variance);
  const double half = solid_volume(state) / 2;
  for (const double d : diameter) {
    result.d50 = d;
    mass += grain_volume(state.dimension, d / 2);
    if (mass >= half) break;
  }
  return result;
}

}  // namespace eg
