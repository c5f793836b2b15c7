#include "measure/zone_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "measure/images.hpp"
#include "measure/volume.hpp"

namespace eg {

namespace {

constexpr double pi = std::numbers::pi;
constexpr double most_zones = 3e7;  // some 4 GB

/// Coordinates of a point in the frame of the grid.
Vec3 local(const ZoneGrid& grid, const Vec3& x) {
  if (grid.shape == ZoneGrid::Shape::box) return x;
  const Vec3 p = x - grid.centre;
  return {p[(grid.axis + 1) % 3], p[(grid.axis + 2) % 3], x[grid.axis]};
}

/// Places of the first and last zone along one coordinate that a stretch meets: [first, last).
struct Places {
  std::size_t first = 0, last = 0;
};

Places met(const std::vector<double>& edges, double from, double to) {
  const auto above = std::upper_bound(edges.begin(), edges.end(), from),
             below = std::lower_bound(edges.begin(), edges.end(), to);
  const auto zones = static_cast<std::ptrdiff_t>(edges.size()) - 1;
  const auto first = std::clamp<std::ptrdiff_t>(above - edges.begin() - 1, 0, zones);
  const auto last = std::clamp<std::ptrdiff_t>(below - edges.begin(), 0, zones);
  return {static_cast<std::size_t>(first), static_cast<std::size_t>(std::max(first, last))};
}

/// Zones that a grain may reach into.
std::array<Places, 3> places_of(const ZoneGrid& grid, int dimension, const Vec3& p, double radius) {
  const auto& e = grid.edges;
  const auto along_z = dimension == 2 ? Places{0, 1} : met(e[2], p.z - radius, p.z + radius);
  if (grid.shape == ZoneGrid::Shape::box)
    return {met(e[0], p.x - radius, p.x + radius), met(e[1], p.y - radius, p.y + radius), along_z};
  const double distance = std::hypot(p.x, p.y);
  return {met(e[0], distance - radius, distance + radius), Places{0, e[1].size() - 1}, along_z};
}

Extent between(const std::vector<double>& edges, std::size_t place) { return {edges[place], edges[place + 1]}; }

/// One zone of the grid in its own frame, and what it holds.
struct Cell3 {
  ZoneGrid::Shape shape;
  std::array<Extent, 3> bounds;

  template <class F>
  auto visit(const F& f) const {
    return shape == ZoneGrid::Shape::box ? f(BoxZone{bounds[0], bounds[1], bounds[2]})
                                         : f(CylinderZone{bounds[2], bounds[0], bounds[1]});
  }
};

std::size_t place(const ZoneGrid& grid, std::size_t a, std::size_t b, std::size_t c) {
  return (a * grid.zones(1) + b) * grid.zones(2) + c;
}

std::vector<ZoneMeasures> empty_zones(const ZoneGrid& grid, int dimension) {
  const auto count = [&](int k) { return static_cast<double>(grid.zones(k)); };
  if (count(0) * count(1) * count(2) > most_zones)
    throw InputError(fmt::format("{:.2g} zones to measure are more than {:.2g}; make them larger",
                                 count(0) * count(1) * count(2), most_zones));
  std::vector<ZoneMeasures> zones;
  for (std::size_t a = 0; a < grid.zones(0); ++a)
    for (std::size_t b = 0; b < grid.zones(1); ++b)
      for (std::size_t c = 0; c < grid.zones(2); ++c) {
        const Cell3 cell{grid.shape, {between(grid.edges[0], a), between(grid.edges[1], b), between(grid.edges[2], c)}};
        zones.push_back({.bounds = cell.bounds});
        zones.back().volume = cell.visit([&](const auto& zone) { return volume_of(zone, dimension); });
      }
  return zones;
}

/// Adds one grain, or one image of it, to the zones.
void add_grain(const ZoneGrid& grid, int dimension, const Vec3& p, double radius, std::vector<ZoneMeasures>& zones) {
  const auto [first, second, third] = places_of(grid, dimension, p, radius);
  for (std::size_t a = first.first; a < first.last; ++a)
    for (std::size_t b = second.first; b < second.last; ++b)
      for (std::size_t c = third.first; c < third.last; ++c) {
        ZoneMeasures& zone = zones[place(grid, a, b, c)];
        Cell3{grid.shape, zone.bounds}.visit([&](const auto& shape) {
          zone.solid += volume_inside(shape, dimension, p, radius);
          zone.grains += holds(shape, dimension, p);
        });
      }
}

/// A sphere around all zones.
struct Ball {
  Vec3 centre;
  double radius = 0;
};

Ball ball_around(const ZoneGrid& grid, int dimension) {
  const auto& e = grid.edges;
  const auto middle = [&](std::size_t k) { return 0.5 * (e[k].front() + e[k].back()); };
  const auto half = [&](std::size_t k) { return 0.5 * (e[k].back() - e[k].front()); };
  if (grid.shape == ZoneGrid::Shape::box) {
    const double z = dimension == 3 ? half(2) : 0;
    return {{middle(0), middle(1), dimension == 3 ? middle(2) : 0},
            std::sqrt(half(0) * half(0) + half(1) * half(1) + z * z)};
  }
  Ball ball{grid.centre, e[0].back()};
  if (dimension == 3) ball.centre[grid.axis] = middle(2), ball.radius = std::hypot(e[0].back(), half(2));
  return ball;
}

/// Radii between cylinder walls along the axis of the grid, whose centre goes to the mean of theirs (a stack of rings
/// has many); without walls from the axis to the outermost grain.
Extent cylinder_walls(const State& state, ZoneGrid& grid) {
  Extent radius{0, 0};
  Vec3 centre;
  double rings = 0;
  for (const Wall& wall : state.walls) {
    if (wall.shape != Wall::cylinder || std::abs(wall.normal[grid.axis]) != 1) continue;
    if (wall.hollow)
      radius.high = std::max(radius.high, wall.radius), centre += wall.point, ++rings;
    else
      radius.low = std::max(radius.low, wall.radius);
  }
  if (rings > 0) {
    grid.centre = (1 / rings) * centre;
    return radius;
  }
  for (std::size_t i = 0; i < state.grains.size(); ++i) {
    const Vec3 p = local(grid, state.grains.position[i].vec());
    radius.high = std::max(radius.high, std::hypot(p.x, p.y) + state.grains.radius(i));
  }
  return radius;
}

}  // namespace

std::array<Extent, 3> specimen_extents(const State& state) {
  std::array<Extent, 3> extents;
  for (int k = 0; k < 3; ++k) {
    const auto axis = static_cast<std::size_t>(k);
    if (k >= state.dimension) {
      extents[axis] = {0, 1};
      continue;
    }
    Extent filled{INFINITY, -INFINITY};
    for (std::size_t i = 0; i < state.grains.size(); ++i) {
      const double x = state.grains.position[i].vec()[k], r = state.grains.radius(i);
      filled.low = std::min(filled.low, x - r), filled.high = std::max(filled.high, x + r);
    }
    const Extent gap = wall_gap(state, k);
    const double origin = state.cell.origin[k];
    if (state.cell.periodic[axis])
      extents[axis] = {origin, origin + state.cell.h(k, k)};
    else
      extents[axis] = {std::isfinite(gap.low) ? gap.low : filled.low, std::isfinite(gap.high) ? gap.high : filled.high};
  }
  return extents;
}

ZoneGrid whole_specimen(const State& state, ZoneGrid::Shape shape, int axis) {
  const auto extents = specimen_extents(state);
  ZoneGrid grid{.shape = shape, .axis = axis};
  for (std::size_t k = 0; k < 3; ++k) {
    grid.edges[k] = {extents[k].low, extents[k].high};
    grid.centre[static_cast<int>(k)] = 0.5 * (extents[k].low + extents[k].high);
  }
  if (shape == ZoneGrid::Shape::box) return grid;
  const Extent height = extents[static_cast<std::size_t>(axis)];
  const Extent radius = cylinder_walls(state, grid);
  grid.edges = {std::vector{radius.low, radius.high}, {0., 2 * pi}, {height.low, height.high}};
  return grid;
}

ZoneTable measure_zones(const State& state, const ZoneGrid& grid) {
  ZoneTable table{.zones = empty_zones(grid, state.dimension)};
  const Ball ball = ball_around(grid, state.dimension);
  for (std::size_t i = 0; i < state.grains.size(); ++i) {
    const Vec3 x = state.grains.position[i].vec();
    const double r = state.grains.radius(i);
    visit_images(state.cell, x, ball.centre, ball.radius + r,
                 [&](const Vec3& shift) { add_grain(grid, state.dimension, local(grid, x + shift), r, table.zones); });
  }
  for (std::size_t k = 0; k < 3; ++k) table.whole.bounds[k] = {grid.edges[k].front(), grid.edges[k].back()};
  for (const auto& zone : table.zones)
    table.whole.volume += zone.volume, table.whole.solid += zone.solid, table.whole.grains += zone.grains;
  double filled = 0;
  for (const auto& zone : table.zones)
    if (zone.solid > 0) table.variance += std::pow(zone.void_ratio() - table.whole.void_ratio(), 2), ++filled;
  if (filled > 0) table.variance /= filled;
  return table;
}

}  // namespace eg
