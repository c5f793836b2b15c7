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

/// Of the lists as they are.
Schedule schedule_of(const State& state) {
  Schedule schedule;
  make_schedule(schedule, state.grains.size(), Contacts::chunk, state.contacts.j, state.contacts.chunk_begin);
  return schedule;
}

/// Every grain moves at random, by some `size` [m].
void shake(State& state, double size, Random& random) {
  for (auto& p : state.grains.position) p.set(p.vec() + Vec3{random.normal(), random.normal(), random.normal()} * size);
}

class StandingBoundOf : public ::testing::TestWithParam<std::string> {};

TEST_P(StandingBoundOf, HoldsTheExactValueWheneverItStands) {
  Scene scene = test::scene_of(GetParam());
  scene.materials[0].bond_modulus = 5e9;  // couples that matter
  // Up to a quarter of a radius: contacts come, go, grow and turn. Bonds would break: they part by a fortieth.
  const double size = scene.contact.law == "linear-parallel-bond" ? 1e-6 : 1e-5;
  int stood = 0, fell = 0, beyond = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    State state = touching_cluster(scene, seed);
    list_with_history(state, scene);
    if (linearise(scene, state).springs.empty()) continue;
    StandingBounds bounds(scene);
    Random random(seed);
    const double lower =
        bounds.renew(state, schedule_of(state), {.time = 0, .slack = 0.1, .room = 0.15, .floor = 0, .step = 1});
    EXPECT_LE(lower, exact(scene, state) * (1 + 1e-12));
    EXPECT_GE(state.policy.bound.value, exact(scene, state));
    for (int k = 0; k < 25; ++k) {
      shake(state, size * (1 + k), random);
      refresh_contacts(state);
      ASSERT_TRUE(bounds.follow(state));
      const double now = exact(scene, state);
      beyond += now > state.policy.bound.value;
      if (bounds.check(state, schedule_of(state), 0, 0.1).stands) {
        ++stood;
        EXPECT_LE(now, state.policy.bound.value * (1 + 1e-12)) << "seed " << seed << ", shake " << k;
      } else {
        ++fell;
        bounds.renew(state, schedule_of(state), {.time = 0, .slack = 0.1, .room = 0.15, .floor = 0, .step = 1});
      }
    }
  }
  EXPECT_GT(stood, 200);
  EXPECT_GT(fell, scene.contact.law == "hertz-mindlin" ? 10 : 1);
  const int least = scene.contact.law == "hertz-mindlin" ? 5 : -1;
  EXPECT_GT(beyond, least);  // the shaking does pass the bound now and then
}

// A grain apart from all others meets some of them: nothing else changes, and none of its pairs was known.
TEST_P(StandingBoundOf, HoldsTheExactValueWhenNewPairsLeaveItAsItIs) {
  Scene scene = test::scene_of(GetParam());
  scene.materials[0].bond_modulus = 5e9;
  int stood = 0, fell = 0, beyond = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    State state = touching_cluster(scene, seed);
    const auto furthest =
        std::ranges::max_element(state.grains.position, {}, [](const Quad& p) { return dot(p.vec(), p.vec()); });
    const Vec3 inside = furthest->vec();
    furthest->set(inside + inside * (4e-3 / norm(inside)));
    const Index id = state.grains.id[static_cast<std::size_t>(furthest - state.grains.position.begin())];
    rebuild_neighbours(state, 8e-3, 2e-5);
    list_with_history(state, scene);
    if (linearise(scene, state).springs.empty()) continue;
    StandingBounds bounds(scene);
    bounds.renew(state, schedule_of(state), {.time = 0, .slack = 0.1, .room = 0.02, .floor = 0, .step = 1});
    const auto at = std::ranges::find(state.grains.id, id) - state.grains.id.begin();
    state.grains.position[static_cast<std::size_t>(at)].set(inside * 0.4);
    refresh_contacts(state);
    ASSERT_TRUE(bounds.follow(state));
    const double now = exact(scene, state);
    beyond += now > state.policy.bound.value;
    const bool stands = bounds.check_fresh(state, 0, 0.1);
    ++(stands ? stood : fell);
    if (stands) {
      EXPECT_LE(now, state.policy.bound.value * (1 + 1e-12)) << "seed " << seed;
    }
  }
  EXPECT_GT(stood, 10);
  const bool close = scene.contact.law == "hertz-mindlin";  // bounds of couples are several times too large
  EXPECT_GT(fell, close ? 2 : -1);
  EXPECT_GT(beyond, close ? 0 : -1);
}

INSTANTIATE_TEST_SUITE_P(Laws, StandingBoundOf,
                         ::testing::Values("hertz-mindlin", "linear-rolling", "linear-parallel-bond"),
                         [](const auto& info) { return std::string(info.param).substr(info.param.find('-') + 1, 4); });

TEST(StandingBound, ForeseesCollisions) {
  const Scene scene = test::scene_of("hertz-mindlin");
  State state = touching_cluster(scene, 3);
  for (auto& v : state.grains.velocity) v.set({0, 0, 0});
  StandingBounds bounds(scene);
  bounds.renew(state, schedule_of(state), {.time = 0, .slack = 0.1, .room = 0.05, .floor = 0, .step = 1});
  EXPECT_TRUE(bounds.check(state, schedule_of(state), 1e-3, 0.1).stands) << "nothing moves";
  Random random(1);
  for (auto& v : state.grains.velocity) v.set(Vec3{random.normal(), random.normal(), random.normal()} * 3e3);
  EXPECT_FALSE(bounds.check(state, schedule_of(state), 1e-3, 0.1).stands) << "everything rushes together";
}

TEST(StandingBound, EndsWhenGrainsAreSortedAnew) {
  const Scene scene = test::scene_of("hertz-mindlin");
  State state = touching_cluster(scene, 3);
  StandingBounds bounds(scene);
  bounds.renew(state, schedule_of(state), {.time = 0, .slack = 0.1, .room = 0.05, .floor = 0, .step = 1});
  std::swap(state.grains.id[0], state.grains.id[1]);
  EXPECT_FALSE(bounds.follow(state));
}

}  // namespace
}  // namespace eg
