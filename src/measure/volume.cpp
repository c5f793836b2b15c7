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

Extent wall_gap(const State& state, int k) {
  Extent gap;
  for (const Wall& wall : state.walls) {
    if (wall.shape != Wall::plane) continue;
    if (wall.normal[k] == 1) gap.low = std::max(gap.low, wall.point[k]);
    if (wall.normal[k] == -1) gap.high = std::min(gap.high, wall.point[k]);
  }
  return gap;
}

double specimen_volume(const State& state) {
  Mat3 edges = state.cell.h;
  for (int k = 0; k < state.dimension; ++k)
    if (const double gap = wall_gap(state, k).length(); std::isfinite(gap)) edges(k, k) = gap;
  for (const Wall& wall : state.walls)
    if (wall.shape == Wall::cylinder && wall.hollow)
      for (int k = 0; k < 3; ++k)
        if (std::abs(wall.normal[k]) == 1) return std::numbers::pi * wall.radius * wall.radius * edges(k, k);
  return edges(0, 0) * edges(1, 1) * edges(2, 2);
}

double solid_volume(const State& state) {
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
