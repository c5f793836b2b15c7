// Contacts as a check of the certified step counts them: eight at a time, and the same springs as the linearised
// packing.
#include <gtest/gtest.h>

#include <numeric>

#include "assembly/linearise.hpp"
#include "contact/laws.hpp"
#include "dynamics/engine.hpp"
#include "search/neighbours.hpp"
#include "support/scenes.hpp"
#include "timestep/pressed.hpp"

namespace eg {
namespace {

class PressedBy : public ::testing::TestWithParam<std::string> {};

State touching(const Scene& scene, std::uint64_t seed) {
  State state = test::cluster(scene, 30, seed, 0.9);
  rebuild_neighbours(state, 4e-4, 2e-5);
  Engine engine(scene, state);
  if (scene.contact.law == "linear-parallel-bond") engine.bond({.gap = 1e-5});
  return state;
}

std::vector<Spring> counted(const Pressed& pressed) {
  std::vector<Spring> springs;
  for (const Spring& s : pressed.network.springs)
    if (acts(s) && !s.couple) springs.push_back(s);
  return springs;
}

TEST_P(PressedBy, AtRestTheSpringsAreThoseOfTheLinearisedPacking) {
  const Scene scene = test::scene_of(GetParam());
  State state = touching(scene, 3);
  for (auto& v : state.grains.velocity) v.set({0, 0, 0});
  state.policy.bound = {};
  state.policy.bound.step = 1;
  Pressed pressed;
  lay_out(scene, state, pressed);
  press_contacts(scene, state, {.time = 0, .slack = 0}, pressed);
  std::vector<Spring> exact;
  for (const Spring& s : linearise(scene, state).springs)
    if (!s.couple) exact.push_back(s);
  const std::vector<Spring> found = counted(pressed);
  ASSERT_EQ(found.size(), exact.size());
  ASSERT_GT(found.size(), 10u);
  for (std::size_t c = 0; c < found.size(); ++c) {
    EXPECT_EQ(found[c].i, exact[c].i);
    EXPECT_EQ(found[c].j, exact[c].j);
    EXPECT_NEAR(found[c].normal / exact[c].normal, 1, 1e-12);
    EXPECT_NEAR(found[c].tangential, exact[c].tangential, 1e-12 * exact[c].normal);
    EXPECT_NEAR(found[c].arm_i / exact[c].arm_i, 1, 1e-12);
    EXPECT_NEAR(norm(found[c].n - exact[c].n), 0, 1e-12);
  }
}

// What a contact is allowed covers where straight motion takes it, unless its energy is used up before.
TEST_P(PressedBy, WhatIsAllowedCoversWhereSlowMotionLeads) {
  const Scene scene = test::scene_of(GetParam());
  State state = touching(scene, 4);
  for (std::size_t i = 0; i < state.grains.size(); ++i)
    state.grains.velocity[i].set(Vec3{0, 0, 0} - state.grains.position[i].vec() * 1e3);
  state.policy.bound = {};
  state.policy.bound.step = 1;
  Pressed pressed;
  lay_out(scene, state, pressed);
  const double time = 1e-12;  // overlaps grow by some 1e-9 of themselves
  press_contacts(scene, state, {.time = time, .slack = 0}, pressed);
  for (auto& p : state.grains.position) p.set(p.vec() * (1 - 1e3 * time));
  int touching = 0;
  visit_contacts(scene, state, [&](const ContactPoint& p) {
    if (p.j == no_index || p.geometry.overlap <= 0) return;
    ++touching;
    EXPECT_LE(p.geometry.overlap, state.policy.bound.overlap[p.entry] * (1 + 1e-12));
  });
  EXPECT_GT(touching, 10);
}

// What a look adds up grain by grain is what the springs add up to, whatever the weights.
TEST_P(PressedBy, ALookAddsUpWhatTheNetworkAddsUp) {
  const Scene scene = test::scene_of(GetParam());
  State state = touching(scene, 5);
  Random random(5);
  for (auto& v : state.grains.velocity) v.set({random.normal(), random.normal(), random.normal()});
  StandingBound& bound = state.policy.bound;
  bound = {};
  bound.step = 1;
  const PressOptions options{.time = 1e-8, .slack = 0.1};
  Pressed pressed;
  lay_out(scene, state, pressed);
  press_contacts(scene, state, options, pressed);
  bound.value = 1e16, bound.grain.assign(state.grains.size(), 0.5e16), bound.turning.assign(state.grains.size(), 0.0);
  Look look;
  lay_out(state, look);
  look_at_all(scene, state, options, look);
  bound_grains(state, look.rows, look.terms, look.ranges, look.plays);
  press_contacts(scene, state, {options.time, options.slack, look.weight}, pressed);
  const Sides sides(pressed.network);
  const std::vector<GrainPlay> plays = plays_of(sides, pressed.weight, pressed.motion);
  BlockRanges ranges(sides.size());
  std::vector<Index> all(sides.size());
  std::iota(all.begin(), all.end(), Index{0});
  block_ranges(sides, pressed.weight, all, ranges);
  int loaded = 0;
  for (Index g = 0; g < sides.size(); ++g) {
    loaded += ranges.high[g] > 0;
    EXPECT_NEAR(look.ranges.high[g], ranges.high[g], 1e-9 * ranges.high[g]);
    EXPECT_NEAR(look.ranges.low[g], ranges.low[g], 1e-9 * ranges.low[g]);
    EXPECT_GE(look.plays[g].turn, plays[g].turn * (1 - 1e-12));
    EXPECT_GE(look.plays[g].counted, plays[g].counted * (1 - 1e-12));
    EXPECT_GE(look.plays[g].ahead, plays[g].ahead * (1 - 1e-12));
    EXPECT_LE(look.plays[g].turn, plays[g].turn * 1.3);
    EXPECT_LE(look.plays[g].ahead, plays[g].ahead * 1.3);
  }
  EXPECT_GT(loaded, 10);
}

INSTANTIATE_TEST_SUITE_P(Laws, PressedBy, ::testing::ValuesIn(law_names()), [](const auto& info) {
  std::string name = info.param;
  std::erase(name, '-');
  return name;
});

}  // namespace
}  // namespace eg
