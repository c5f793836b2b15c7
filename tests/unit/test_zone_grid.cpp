// Void ratios in zones of a container.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/random.hpp"
#include "measure/volume.hpp"
#include "measure/zone_grid.hpp"
#include "support/scenes.hpp"

namespace eg {
namespace {

constexpr double pi = std::numbers::pi;
using Shape = ZoneGrid::Shape;

/// Grains anywhere in a box of edge 1 and beyond, of radii 1:20.
State scattered(int dimension, std::uint64_t seed = 4) {
  Random random(seed);
  State state;
  state.dimension = dimension;
  for (int k = 0; k < 200; ++k)
    state.grains.position.push_back({random.uniform(), random.uniform(), dimension == 3 ? random.uniform() : 0.0,
                                     0.005 * std::pow(20, random.uniform())});
  state.grains.velocity.resize(200);
  return state;
}

void equal_parts(ZoneGrid& grid, std::size_t coordinate, int count) {
  auto& edges = grid.edges[coordinate];
  const double from = edges.front(), to = edges.back();
  edges.clear();
  for (int k = 0; k <= count; ++k) edges.push_back(from + (to - from) * k / count);
}

TEST(ZoneGrid, ZonesOfTheWholeSpecimenHoldEveryGrainOnce) {
  for (const int dimension : {2, 3})
    for (const auto shape : {Shape::box, Shape::cylinder}) {
      const State state = scattered(dimension);
      ZoneGrid grid = whole_specimen(state, shape, 2);
      for (std::size_t k = 0; k < 3; ++k) equal_parts(grid, k, 3 + static_cast<int>(k) * (dimension - 2));
      if (dimension == 2) grid.edges[2] = {0, 1};
      const auto table = measure_zones(state, grid);
      EXPECT_EQ(table.zones.size(), grid.zones(0) * grid.zones(1) * grid.zones(2));
      EXPECT_NEAR(table.whole.solid / solid_volume(state), 1, 1e-13) << dimension;
      EXPECT_EQ(table.whole.grains, state.grains.size());
      EXPECT_NEAR(table.whole.volume,
                  grid.shape == Shape::box
                      ? (grid.edges[0].back() - grid.edges[0].front()) *
                            (grid.edges[1].back() - grid.edges[1].front()) *
                            (grid.edges[2].back() - grid.edges[2].front())
                      : pi * std::pow(grid.edges[0].back(), 2) * (grid.edges[2].back() - grid.edges[2].front()),
                  1e-13);
    }
}

TEST(ZoneGrid, APeriodicCellIsSharedOutWhereverItsZonesBegin) {
  const Scene scene = test::lattice_scene("hertz-mindlin", "fcc", {3, 3, 3}, 1e-3);
  State state = test::state_of(scene);
  state.cell.h(0, 1) = 0.3 * state.cell.h(0, 0), state.cell.h(1, 2) = -0.2 * state.cell.h(1, 1);  // sheared
  for (auto& x : state.grains.position) {
    const Vec3 place = x.vec();
    x.set(place + Vec3{0.3 * place.y, -0.2 * place.z, 0});
  }
  for (const Vec3& shift : {Vec3{1.1e-4, 2.3e-4, 3.1e-4}, Vec3{1e-3, -7e-3, 3e-3}}) {
    ZoneGrid grid = whole_specimen(state, Shape::box, 2);
    for (std::size_t k = 0; k < 3; ++k) {
      for (double& edge : grid.edges[k]) edge += shift[static_cast<int>(k)];
      equal_parts(grid, k, 4);
    }
    const auto table = measure_zones(state, grid);
    EXPECT_NEAR(table.whole.solid / solid_volume(state), 1, 1e-12);
    EXPECT_NEAR(table.whole.solid_fraction(), solid_volume(state) / specimen_volume(state), 1e-12);
    EXPECT_EQ(table.whole.grains, state.grains.size());
  }
}

TEST(ZoneGrid, TheAxisOfACylinderMayLieAlongAnyAxis) {
  const State upright = scattered(3);
  ZoneGrid grid = whole_specimen(upright, Shape::cylinder, 2);
  equal_parts(grid, 0, 3), equal_parts(grid, 1, 5), equal_parts(grid, 2, 2);
  const auto expected = measure_zones(upright, grid);
  for (const int axis : {0, 1}) {
    const auto turned = [&](const Vec3& x) {  // z goes to `axis`, x and y follow in turn
      Vec3 t;
      t[axis] = x.z, t[(axis + 1) % 3] = x.x, t[(axis + 2) % 3] = x.y;
      return t;
    };
    State lying = upright;
    for (auto& x : lying.grains.position) x.set(turned(x.vec()));
    ZoneGrid other = whole_specimen(lying, Shape::cylinder, axis);
    EXPECT_NEAR(other.edges[0].back(), grid.edges[0].back(), 1e-15);
    equal_parts(other, 0, 3), equal_parts(other, 1, 5), equal_parts(other, 2, 2);
    const auto table = measure_zones(lying, other);
    for (std::size_t k = 0; k < table.zones.size(); ++k) {
      EXPECT_NEAR(table.zones[k].solid, expected.zones[k].solid, 1e-15);
      EXPECT_EQ(table.zones[k].grains, expected.zones[k].grains);
    }
    EXPECT_NEAR(table.variance, expected.variance, 1e-10);
  }
}

TEST(ZoneGrid, WallsAndCellsMakeTheContainer) {
  State state = scattered(3);
  test::add_plane(state, {0, 0, -0.5}, {0, 0, 1});
  test::add_plane(state, {0, 0, 2}, {0, 0, -1});
  state.cell.periodic = {true, false, false};
  state.cell.origin.x = -0.25, state.cell.h(0, 0) = 1.5;
  const auto extents = specimen_extents(state);
  EXPECT_EQ(extents[0].low, -0.25);
  EXPECT_EQ(extents[0].high, 1.25);
  EXPECT_EQ(extents[2].low, -0.5);
  EXPECT_EQ(extents[2].high, 2);
  EXPECT_GT(extents[1].length(), 0.9);
  EXPECT_LT(extents[1].length(), 1.2);
}

TEST(ZoneGrid, RingsMakeACylinder) {
  State state = scattered(3);
  const auto ring = [](double x, double radius, bool hollow) {
    Wall wall;
    wall.shape = Wall::cylinder, wall.point = {x, 0.5, 0}, wall.normal = {0, 0, 1};
    wall.radius = radius, wall.hollow = hollow;
    return wall;
  };
  state.walls = {ring(0.4, 0.7, true), ring(0.6, 0.7, true), ring(0.5, 0.1, false)};
  const ZoneGrid grid = whole_specimen(state, Shape::cylinder, 2);
  EXPECT_EQ(grid.edges[0], (std::vector{0.1, 0.7}));
  EXPECT_NEAR(grid.centre.x, 0.5, 1e-15);
  EXPECT_NE(whole_specimen(state, Shape::cylinder, 0).edges[0], grid.edges[0]);  // no walls along x
}

TEST(ZoneGrid, VarianceIsThatOfTheVoidRatios) {
  // two layers of a box, one grain in the lower one, two in the upper: e = 1/s − 1, 1/(2s) − 1, as one 2/(3s) − 1
  State state;
  state.grains.position = {{0.5, 0.5, 0.5, 0.3}, {0.4, 0.4, 1.5, 0.3}, {0.6, 0.6, 1.5, 0.3}};
  state.grains.velocity.resize(3);
  const ZoneGrid grid{.edges = {std::vector{0., 1.}, {0., 1.}, {0., 1., 2., 3.}}};
  const auto table = measure_zones(state, grid);
  const double s = grain_volume(3, 0.3);
  const double lower = 1 / s - 1, upper = 0.5 / s - 1, whole = (3 - 3 * s) / (3 * s);
  EXPECT_NEAR(table.zones[0].void_ratio(), lower, 1e-12);
  EXPECT_NEAR(table.zones[1].void_ratio(), upper, 1e-12);
  EXPECT_TRUE(std::isinf(table.zones[2].void_ratio()));  // empty: no part of the variance
  EXPECT_NEAR(table.whole.void_ratio(), whole, 1e-12);
  EXPECT_NEAR(table.variance, (std::pow(lower - whole, 2) + std::pow(upper - whole, 2)) / 2, 1e-10);
}

}  // namespace
}  // namespace eg
