// Contacts as a check of the certified step counts them: eight at a time, and the same springs as the linearised
// packing.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <numeric>

#include "assembly/linearise.hpp"
#include "contact/laws.hpp"
#include "dynamics/engine.hpp"
#include "search/neighbours.hpp"
#include "support/scenes.hpp"
#include "timestep/look.hpp"

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
  const Pressed pressed = press_contacts(scene, state, {.time = 0, .slack = 0});
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
  const double time = 1e-12;  // overlaps grow by some 1e-9 of themselves
  press_contacts(scene, state, {.time = time, .slack = 0});
  for (auto& p : state.grains.position) p.set(p.vec() * (1 - 1e3 * time));
  int touching = 0;
  visit_contacts(scene, state, [&](const ContactPoint& p) {
    if (p.j == no_index || p.geometry.overlap <= 0) return;
    ++touching;
    EXPECT_LE(p.geometry.overlap, state.policy.bound.overlap[p.entry] * (1 + 1e-12));
  });
  EXPECT_GT(touching, 10);
}

// What a look says of every grain is not less than what its contacts add up to, one by one, and little more.
TEST_P(PressedBy, ALookBoundsWhatTheContactsAddUpTo) {
  const Scene scene = test::scene_of(GetParam());
  State state = touching(scene, 5);
  Random random(5);
  for (auto& v : state.grains.velocity) v.set({random.normal(), random.normal(), random.normal()});
  StandingBound& bound = state.policy.bound;
  bound = {};
  bound.step = 1;
  const PressOptions options{.time = 1e-8, .slack = 0.1};
  press_contacts(scene, state, options);
  bound.value = 1e16, bound.grain.assign(state.grains.size(), 0.5e16);
  Schedule schedule;
  make_schedule(schedule, state.grains.size(), Contacts::chunk, state.contacts.j, state.contacts.chunk_begin);
  Look look;
  look_at_all(scene, state, options, schedule, look);
  const std::vector<double> rough = bound.grain;  // all far below the bound
  for (std::size_t g = 0; g < state.grains.size(); g += 8) {
    const std::size_t end = std::min(g + 8, state.grains.size());
    const EightBounds close = bound_eight(state, look.rows, g, end, look.terms, 0);
    for (std::size_t k = g; k < end; ++k) bound.grain[k] = close.high[k - g] + close.play[k - g];
  }

  Network net = bare_network(scene, state);
  std::vector<double> weight;
  std::vector<SpringMotion> motion;
  std::vector<std::size_t> pairs, walls(state.wall_contacts.size());
  for (std::size_t c = 0; c < state.contacts.size(); ++c)
    if (!state.contacts.is_padding(c)) pairs.push_back(c);
  std::iota(walls.begin(), walls.end(), std::size_t{0});
  const auto add = [&](const Spring& s, const SpringMotion& m, double t) {
    net.springs.push_back(s), motion.push_back(m), weight.push_back(t);
  };
  for (const CountedContact& c : counted_contacts(scene, state, {pairs, walls}, options.time)) {
    add(c.spring, c.motion, c.j == no_index ? 1.0 : bound.weight[c.entry]);
    if (c.counted.twisting == 0 && c.counted.rolling == 0) continue;
    for (const Index g : {c.i, c.j}) {
      if (g == no_index || (g == c.j && c.i == c.j)) continue;
      Spring couple;
      couple.i = g, couple.j = no_index, couple.couple = true, couple.n = c.spring.n;
      couple.normal = c.counted.twisting, couple.tangential = c.counted.rolling;
      add(couple, c.motion, 1.0);
    }
  }
  const Sides sides(net);
  const std::vector<double> plays = plays_of(sides, weight, motion);
  int loaded = 0;
  for (Index g = 0; g < sides.size(); ++g) {
    const Eigen::SelfAdjointEigenSolver<Block> solver(scalar_block(sides, weight, g), Eigen::EigenvaluesOnly);
    const double exact = solver.eigenvalues()(5);
    loaded += exact > 0;
    EXPECT_GE(bound.grain[g], (exact + plays[g]) * (1 - 1e-12));
    EXPECT_LE(bound.grain[g], 1.12 * exact + 1.3 * plays[g] + 1e-9);
    EXPECT_GE(rough[g], (exact + plays[g]) * (1 - 1e-12));
    EXPECT_LE(rough[g], 1.8 * exact + 1.3 * plays[g] + 1e-9);
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
