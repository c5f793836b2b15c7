// How far grains have moved against each other, and that no contact is missed for believing it.
#include <gtest/gtest.h>

#include "dynamics/engine.hpp"
#include "search/travel.hpp"
#include "support/scenes.hpp"

namespace eg {
namespace {

/// Spheres at the nodes of a cubic lattice with gaps, in a periodic cell, sorted along it as a run would have them.
State gas(const Scene& scene, int cells, double speed, std::uint64_t seed) {
  Packing p;
  Random random(seed);
  const double pitch = 2.4e-3;
  p.box = Vec3{1, 1, 1} * (pitch * cells);
  for (int k = 0; k < cells * cells * cells; ++k) {
    p.position.push_back(Vec3{k % cells + .5, k / cells % cells + .5, k / cells / cells + .5} * pitch);
    p.radius.push_back(1e-3 * random.uniform(0.9, 1.1));
  }
  State state = make_state(scene, p);
  for (auto& v : state.grains.velocity) v.set(Vec3{random.normal(), random.normal(), random.normal()} * speed);
  return state;
}

/// x_j − x_i in the nearest image.
Vec3 nearest(const State& state, std::size_t i, std::size_t j) {
  const Vec3 d = state.grains.position[j].vec() - state.grains.position[i].vec();
  Vec3 s = inverse(state.cell.h) * d;
  for (int k = 0; k < 3; ++k) s[k] -= std::round(s[k]);
  return state.cell.h * s;
}

TEST(Travel, BoundsEveryNearPairAndForgetsCommonMotion) {
  const Scene scene = test::scene_of("linear");
  State state = gas(scene, 11, 0, 1);
  Engine engine(scene, state);  // makes the lists
  Blocks blocks;
  blocks.reset(state);
  Random random(2);
  const Vec3 common{3e-4, -2e-4, 1e-4};
  std::vector<Vec3> moved;
  for (auto& x : state.grains.position) {
    moved.push_back(common + Vec3{random.normal(), random.normal(), random.normal()} * 1e-6);
    x.set(x.vec() + moved.back());
  }
  blocks.measure(state);
  const Travel travel = blocks.travel();
  double most = 0, approach = 0;
  for (std::size_t i = 0; i < moved.size(); ++i) {
    most = std::max(most, norm(moved[i]));
    for (std::size_t j = 0; j < i; ++j)
      if (norm(nearest(state, i, j)) < 4 * state.list.longest) approach = std::max(approach, norm(moved[i] - moved[j]));
  }
  EXPECT_GE(travel.most, most * (1 - 1e-9));
  EXPECT_LE(travel.most, 1.1 * most);
  EXPECT_GE(travel.approach, approach * (1 - 1e-9));
  EXPECT_LE(travel.approach, 2 * approach);  // not 2 · most, fifty times as much
}

TEST(Travel, StepsBoundWhatPositionsSay) {
  const Scene scene = test::scene_of("linear");
  State state = gas(scene, 9, 0.1, 3);
  state.cell.rate(0, 1) = 5, state.cell.rate(2, 2) = -3;
  Engine engine(scene, state);
  Blocks by_steps, by_positions;
  by_steps.reset(state), by_positions.reset(state);
  for (int k = 0; k < 20; ++k) {
    drift(state, 1e-5, by_steps);
    by_positions.measure(state);
    const Travel bound = by_steps.travel(), now = by_positions.travel();
    EXPECT_GE(bound.most * 1.001, now.most);
    EXPECT_GE(bound.approach * 1.001, now.approach);
    EXPECT_LE(bound.approach, 1.2 * now.approach);
  }
}

TEST(Travel, NoContactOfAStreamingGasIsMissed) {
  const Scene scene = test::scene_of("linear");
  State state = gas(scene, 7, 1, 5);
  for (std::size_t i = 0; i < state.grains.size(); ++i)  // two streams, as in a shear flow, and all of them fast
    state.grains.velocity[i].x += state.grains.position[i].y > 8e-3 ? 6 : 2;
  Engine engine(scene, state);
  engine.kick(2e-6);
  std::size_t touching = 0;
  for (int k = 0; k < 1200; ++k) {
    engine.step(2e-6, TallyLevel::none);
    if (k % 5 != 0) continue;
    std::vector<std::pair<Index, Index>> listed;
    for (std::size_t c = 0; c < state.contacts.size(); ++c)
      listed.emplace_back(state.contacts.i[c], state.contacts.j[c]);
    std::sort(listed.begin(), listed.end());
    for (Index i = 0; i < state.grains.size(); ++i)
      for (Index j = i + 1; j < state.grains.size(); ++j)
        if (norm(nearest(state, i, j)) < state.grains.radius(i) + state.grains.radius(j)) {
          ++touching;
          ASSERT_TRUE(std::binary_search(listed.begin(), listed.end(), std::pair{i, j}))
              << i << " " << j << " step " << k;
        }
  }
  EXPECT_GT(touching, 1000u);
  EXPECT_GT(state.list.builds, 2u);
  EXPECT_LT(state.list.refreshes, 200u);
}

}  // namespace
}  // namespace eg
