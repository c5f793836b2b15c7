// A standing bound: whenever a check says that it stands, it is not below the exact λmax of what was to come.
#include <gtest/gtest.h>

#include "assembly/linearise.hpp"
#include "assembly/stiffness.hpp"
#include "dynamics/engine.hpp"
#include "eigen/dense.hpp"
#include "search/neighbours.hpp"
#include "support/scenes.hpp"
#include "timestep/standing_bound.hpp"

namespace eg {
namespace {

double exact(const Scene& scene, const State& state) {
  return dense_largest(dense_scaled_stiffness(linearise(scene, state))).value;
}

State touching_cluster(const Scene& scene, std::uint64_t seed) {
  State state = test::cluster(scene, 20, seed, 0.9);
  rebuild_neighbours(state, 4e-4, 2e-5);
  return state;
}

/// Lists as a run makes them, with bonds where the law has them.
void list_with_history(State& state, const Scene& scene) {
  if (scene.contact.law == "hertz-mindlin") return;  // without shear here
  Engine engine(scene, state);
  if (scene.contact.law == "linear-parallel-bond") engine.bond({.gap = 1e-5});
}

/// All draw together or apart by up to two per cent: overlaps change, each by its own share, new contacts come,
/// and no direction turns (turning is what a bound does not count).
void breathe(State& state, double factor) {
  for (auto& p : state.grains.position) p.set(p.vec() * factor);
}

class StandingBoundOf : public ::testing::TestWithParam<std::string> {};

TEST_P(StandingBoundOf, HoldsTheExactValueWheneverItStands) {
  Scene scene = test::scene_of(GetParam());
  scene.materials[0].bond_modulus = 5e9;  // couples that matter
  int stood = 0, fell = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    State state = touching_cluster(scene, seed);
    list_with_history(state, scene);
    if (linearise(scene, state).springs.empty()) continue;
    StandingBounds bounds(scene);
    Random random(seed);
    const double lower = bounds.renew(state, {.time = 0, .slack = 0.1, .room = 0.15, .floor = 0, .step = 1});
    EXPECT_LE(lower, exact(scene, state) * (1 + 1e-12));
    EXPECT_GE(state.policy.bound.value, exact(scene, state));
    for (int k = 0; k < 25; ++k) {
      breathe(state, 1 + 0.03 * (random.uniform() - 0.65));
      refresh_contacts(state);
      ASSERT_TRUE(bounds.follow(state));
      const double now = exact(scene, state);
      if (bounds.check(state, 0, 0.1).stands) {
        ++stood;
        EXPECT_LE(now, state.policy.bound.value * (1 + 1e-12)) << "seed " << seed << ", breath " << k;
      } else {
        ++fell;
        bounds.renew(state, {.time = 0, .slack = 0.1, .room = 0.15, .floor = 0, .step = 1});
      }
    }
  }
  EXPECT_GT(stood, 100);
  EXPECT_GT(fell, 5);
}

INSTANTIATE_TEST_SUITE_P(Laws, StandingBoundOf,
                         ::testing::Values("hertz-mindlin", "linear-rolling", "linear-parallel-bond"),
                         [](const auto& info) { return std::string(info.param).substr(info.param.find('-') + 1, 4); });

TEST(StandingBound, FallsWhenThePackingHasPassedIt) {
  const Scene scene = test::scene_of("hertz-mindlin");
  int beyond = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    State state = touching_cluster(scene, seed);
    StandingBounds bounds(scene);
    bounds.renew(state, {.time = 0, .slack = 0.1, .room = 0.05, .floor = 0, .step = 1});
    breathe(state, 0.8);
    refresh_contacts(state);
    ASSERT_TRUE(bounds.follow(state));
    if (exact(scene, state) <= state.policy.bound.value) continue;
    ++beyond;
    EXPECT_FALSE(bounds.check(state, 0, 0.1).stands) << "seed " << seed;
  }
  EXPECT_GT(beyond, 3);
}

TEST(StandingBound, ForeseesCollisions) {
  const Scene scene = test::scene_of("hertz-mindlin");
  State state = touching_cluster(scene, 3);
  for (auto& v : state.grains.velocity) v.set({0, 0, 0});
  StandingBounds bounds(scene);
  bounds.renew(state, {.time = 0, .slack = 0.1, .room = 0.05, .floor = 0, .step = 1});
  EXPECT_TRUE(bounds.check(state, 1e-3, 0.1).stands) << "nothing moves";
  Random random(1);
  for (auto& v : state.grains.velocity) v.set(Vec3{random.normal(), random.normal(), random.normal()} * 3e3);
  EXPECT_FALSE(bounds.check(state, 1e-3, 0.1).stands) << "everything rushes together";
}

TEST(StandingBound, EndsWhenGrainsAreSortedAnew) {
  const Scene scene = test::scene_of("hertz-mindlin");
  State state = touching_cluster(scene, 3);
  StandingBounds bounds(scene);
  bounds.renew(state, {.time = 0, .slack = 0.1, .room = 0.05, .floor = 0, .step = 1});
  std::swap(state.grains.id[0], state.grains.id[1]);
  EXPECT_FALSE(bounds.follow(state));
}

}  // namespace
}  // namespace eg
