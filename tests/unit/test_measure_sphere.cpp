#include <gtest/gtest.h>

#include <cmath>

#include "base/random.hpp"
#include "measure/contact_network.hpp"
#include "measure/measure_sphere.hpp"
#include "measure/stress.hpp"
#include "measure/volume.hpp"
#include "search/neighbours.hpp"
#include "support/scenes.hpp"

namespace eg {
namespace {

State listed(const Scene& scene) {
  State state = test::state_of(scene);
  rebuild_neighbours(state, 1e-4, 1e-5);
  return state;
}

Scene fcc() { return test::lattice_scene("hertz-mindlin", "fcc", {3, 3, 3}, 1e-3); }

/// Some motion that differs from grain to grain, and a cell that deforms.
void stir(State& state) {
  Random random(5);
  for (auto& v : state.grains.velocity) v.set({random.normal(), random.normal(), random.normal()});
  state.cell.rate(0, 1) = 3, state.cell.rate(2, 2) = -1;
}

TEST(MeasureSphere, SegmentsAreCutAtTheSphere) {
  const MeasureSphere unit{{0, 0, 0}, 1};
  EXPECT_DOUBLE_EQ(share_inside({-2, 0, 0}, {2, 0, 0}, unit), 0.5);
  EXPECT_DOUBLE_EQ(share_inside({0, 0, 0}, {0, 4, 0}, unit), 0.25);
  EXPECT_DOUBLE_EQ(share_inside({0, 0, 0.5}, {0, 0.1, 0.5}, unit), 1);
  EXPECT_EQ(share_inside({2, 0, 0}, {3, 0, 0}, unit), 0);
  EXPECT_EQ(share_inside({-2, 1.5, 0}, {2, 1.5, 0}, unit), 0);
  EXPECT_NEAR(share_inside({-2, 0.6, 0}, {2, 0.6, 0}, unit), 0.4, 1e-15);  // chord 1.6 of 4
}

TEST(MeasureSphere, HoldsOneGrainExactly) {
  State state;
  state.grains.position = {{0.3, 0, 0, 1}};
  state.grains.velocity = {{1, 2, 3, 1}};
  const auto around = measure_sphere(state, {}, {{0, 0, 0}, 2});
  EXPECT_NEAR(around.solid_fraction, 1. / 8, 1e-15);
  EXPECT_NEAR(around.void_ratio, 7, 1e-13);
  EXPECT_EQ(around.grains, 1u);
  EXPECT_FALSE(around.velocity_gradient);  // one grain has none
  const auto cut = measure_sphere(state, {}, {{1.5, 0, 0}, 0.5});
  EXPECT_NEAR(cut.solid_fraction * cut.volume, lens_volume(3, 1, 0.5, 1.2), 1e-15);
  EXPECT_EQ(cut.grains, 0u);
  EXPECT_TRUE(std::isinf(measure_sphere(state, {}, {{9, 0, 0}, 0.5}).void_ratio));
}

TEST(MeasureSphere, OneContactHasTheShareOfItsBranch) {
  State state;
  state.grains.position = {{-1, 0, 0, 1.01}, {1, 0, 0, 1.01}};
  state.grains.velocity.resize(2);
  ContactPoint c;
  c.i = 0, c.j = 1, c.branch = {2, 0, 0};
  c.geometry.n = {1, 0, 0}, c.normal.force = 3;
  const std::vector contacts{c};
  for (const double radius : {0.25, 0.5, 1.0, 7.0}) {
    const auto m = measure_sphere(state, contacts, {{0, 0, 0}, radius});
    EXPECT_NEAR(m.stress(0, 0) * m.volume, 3 * std::min(2.0, 2 * radius), 1e-12) << radius;
  }
}

TEST(MeasureSphere, DoesNotMindWhereItLiesInAPeriodicLattice) {
  const Scene scene = fcc();
  State state = listed(scene);
  const auto contacts = touching_contacts(scene, state);
  const Vec3 edge{state.cell.h(0, 0), state.cell.h(1, 1), state.cell.h(2, 2)}, centre{1e-3, 2.2e-3, 0.7e-3};
  const auto here = measure_sphere(state, contacts, {centre, 2.3e-3});
  for (const Vec3& shift : {Vec3{edge.x, 0, 0}, Vec3{0, -edge.y, 3 * edge.z}, (1. / 3) * edge}) {
    const auto there = measure_sphere(state, contacts, {centre + shift, 2.3e-3});
    EXPECT_NEAR(there.solid_fraction, here.solid_fraction, 1e-12);
    EXPECT_EQ(there.grains, here.grains);
    EXPECT_EQ(there.coordination, 12);
    for (std::size_t k = 0; k < 9; ++k) EXPECT_NEAR(there.stress.a[k], here.stress.a[k], 1e-9 * trace(here.stress));
  }
}

TEST(MeasureSphere, ALargeSphereSeesThePackingAsAWhole) {
  const Scene scene = fcc();
  State state = listed(scene);
  stir(state);
  const auto contacts = touching_contacts(scene, state);
  const double volume = specimen_volume(state);
  const Mat3 whole = stress(contacts, volume);
  const auto m = measure_sphere(state, contacts, {{1e-3, 1e-3, 1e-3}, 20e-3});  // several cells across
  EXPECT_NEAR(m.solid_fraction / (solid_volume(state) / volume), 1, 5e-3);
  EXPECT_NEAR(trace(m.stress) / trace(whole), 1, 5e-3);
  ASSERT_TRUE(m.velocity_gradient);
  EXPECT_NEAR((*m.velocity_gradient)(0, 1), 3, 20);  // fluctuations of 1 m/s over centimetres
}

TEST(MeasureSphere, FindsTheGradientOfAHomogeneousMotion) {
  for (const auto* lattice : {"fcc", "hexagonal"}) {
    const Scene scene = test::lattice_scene("hertz-mindlin", lattice, {3, 3, 3}, 1e-3);
    State state = listed(scene);
    state.cell.rate(0, 0) = -2, state.cell.rate(0, 1) = 7, state.cell.rate(1, 1) = 0.5;
    for (auto& v : state.grains.velocity) v.set({4, 5, 0});
    const auto m = measure_sphere(state, {}, {{1e-3, 0, 0}, 3e-3});
    ASSERT_TRUE(m.velocity_gradient) << lattice;
    for (std::size_t k = 0; k < 9; ++k) EXPECT_NEAR(m.velocity_gradient->a[k], state.cell.rate.a[k], 1e-9) << lattice;
  }
}

TEST(MeasureSphere, SpheresOnAFineGridShareTheWholeAmongThem) {
  // the mean over all places of a window that moves through the periodic cell is the value of the packing
  const Scene scene = test::lattice_scene("hertz-mindlin", "square", {2, 2, 1}, 1e-3);
  const State state = listed(scene);
  const auto contacts = touching_contacts(scene, state);
  const double volume = specimen_volume(state);
  double solid = 0, pressure = 0;
  constexpr int n = 160;
  for (int a = 0; a < n; ++a)
    for (int b = 0; b < n; ++b) {
      const Vec3 centre{(a + 0.5) / n * state.cell.h(0, 0), (b + 0.5) / n * state.cell.h(1, 1), 0};
      const auto m = measure_sphere(state, contacts, {centre, 0.6e-3});
      solid += m.solid_fraction / (n * n), pressure += (m.stress(0, 0) + m.stress(1, 1)) / (n * n);
    }
  EXPECT_NEAR(solid / (solid_volume(state) / volume), 1, 1e-3);
  EXPECT_NEAR(pressure / trace(stress(contacts, volume)), 1, 2e-3);
}

}  // namespace
}  // namespace eg
