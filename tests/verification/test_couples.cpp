// Laws that resist rotation of one grain against the other: rolling resistance and parallel bonds, in the solver.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "assembly/apply.hpp"
#include "assembly/linearise.hpp"
#include "assembly/stiffness.hpp"
#include "dynamics/bonds.hpp"
#include "dynamics/engine.hpp"
#include "eigen/dense.hpp"
#include "state/friction.hpp"
#include "state/gather.hpp"
#include "support/scenes.hpp"
#include "timestep/collatz.hpp"
#include "timestep/estimates.hpp"
#include "timestep/interval.hpp"
#include "timestep/splitting.hpp"

using namespace eg;

namespace {

constexpr double radius = 1e-3;

/// Two grains in a periodic cube of 10 mm, the first at `x`, the second to the right of it, with spins and velocities.
State pair_at(const Scene& scene, double x, double overlap) {
  Packing p;
  p.box = {10e-3, 10e-3, 10e-3};
  p.position = {{x, 5e-3, 5e-3}, {x + (2 * radius - overlap) * 0.8, 5e-3 + (2 * radius - overlap) * 0.6, 5e-3}};
  p.radius = {radius, radius};
  State s = make_state(scene, p);
  s.grains.spin[0].set({30, -20, 10}), s.grains.spin[1].set({-15, 25, 40});
  s.grains.velocity[0].set({0.01, 0.02, -0.01}), s.grains.velocity[1].set({-0.02, 0.01, 0.03});
  return s;
}

/// Force and moment on the grain of that id.
ForceRow row_of(const Engine& engine, const State& state, Index id) {
  for (std::size_t i = 0; i < state.grains.size(); ++i)
    if (state.grains.id[i] == id) return gather_row(engine.workspace(), i);
  return {};
}

class CoupleLaw : public ::testing::TestWithParam<std::string> {};

TEST_P(CoupleLaw, ActsOnBothGrainsAlikeAcrossAPeriodicFace) {
  Scene scene = test::scene_of(GetParam());
  std::array<std::array<ForceRow, 2>, 2> rows;
  for (const std::size_t across : {0, 1}) {
    State state = pair_at(scene, across ? 9.5e-3 : 3e-3, 1e-6);
    Engine engine(scene, state);
    if (GetParam() == "linear-parallel-bond") engine.bond({});
    engine.kick(1e-7);
    for (int k = 0; k < 20; ++k) engine.step(1e-7);
    engine.forces(0, TallyLevel::none);  // the step leaves no rows behind
    const ContactPoint contact = [&] {
      ContactPoint found;
      visit_contacts(scene, state, [&](const ContactPoint& p) { found = p; });
      return found;
    }();
    const auto &a = rows[across][0] = row_of(engine, state, 1), &b = rows[across][1] = row_of(engine, state, 2);
    const Vec3 n = contact.geometry.n * (state.grains.id[contact.i] == 1 ? 1.0 : -1.0);
    const Vec3 branch = n * norm(contact.branch);
    EXPECT_LT(norm(a.force + b.force), 1e-14 * norm(a.force));
    EXPECT_LT(norm(a.moment + b.moment + cross(branch, b.force)), 1e-12 * norm(a.moment));
    const Vec3 couple = (a.moment - b.moment) * 0.5;  // what is left once the equal arms of T are taken out
    EXPECT_GT(norm(couple), 1e-3 * norm(a.moment));
    const double twisting = std::abs(dot(couple, n));
    if (GetParam() == "linear-rolling") {
      EXPECT_LT(twisting, 1e-12 * norm(couple));
    } else {
      EXPECT_GT(twisting, 1e-2 * norm(couple));
    }
  }
  for (const std::size_t g : {0, 1}) {
    EXPECT_LT(norm(rows[0][g].force - rows[1][g].force), 1e-9 * norm(rows[0][g].force));
    EXPECT_LT(norm(rows[0][g].moment - rows[1][g].moment), 1e-9 * norm(rows[0][g].moment));
  }
}

INSTANTIATE_TEST_SUITE_P(Laws, CoupleLaw, ::testing::Values("linear-rolling", "linear-parallel-bond"),
                         [](const auto& info) { return std::string(info.param).substr(7, 4); });

TEST(Couples, AreInTheMatrixInItsProductsAndInEveryBound) {
  for (const std::string law : {"linear-rolling", "linear-parallel-bond"}) {
    Scene scene = test::lattice_scene(law, "fcc", {3, 3, 3}, 0.03);
    scene.specimen.radius_scatter = 0.01;
    scene.materials[0].bond_radius_ratio = 1, scene.materials[0].bond_modulus = 5e9;  // couples that matter
    State state = test::state_of(scene);
    Engine engine(scene, state);
    if (law == "linear-parallel-bond") engine.bond({});
    const Network net = linearise(scene, state);
    ASSERT_EQ(net.springs.size(), 2 * net.contacts());
    const Eigen::MatrixXd a = dense_scaled_stiffness(net);
    Network plain = net;
    std::erase_if(plain.springs, [](const Spring& s) { return s.couple; });
    const double lambda = dense_largest(a).value;
    EXPECT_GT(lambda, 1.0001 * dense_largest(dense_scaled_stiffness(plain)).value) << law;

    const StiffnessOperator op(net, StiffnessOperator::Scaling::mass);
    Random random(1);
    std::vector<double> x(op.rows()), y(op.rows());
    for (double& v : x) v = random.normal();
    op.apply(x, y);
    const Eigen::VectorXd exact = a * Eigen::Map<const Eigen::VectorXd>(x.data(), a.cols());
    EXPECT_LT((exact - Eigen::Map<const Eigen::VectorXd>(y.data(), a.cols())).norm(), 1e-13 * exact.norm());

    EXPECT_GE(splitting_bound(net).value, lambda * (1 - 1e-12)) << law;
    EXPECT_GE(splitting_bound(net, {.matrix_sweeps = 0}).value, lambda * (1 - 1e-12)) << law;
    EXPECT_GE(collatz_bound(net).value, lambda * (1 - 1e-12)) << law;
    const double limit = 2 / std::sqrt(lambda);
    EXPECT_LE(element_time_step(net), limit) << law;
    EXPECT_LE(gershgorin_time_step(net), limit) << law;
    const auto interval = step_interval(net, {.dense_limit = 0});
    EXPECT_LE(interval.dt_safe, limit) << law;
    EXPECT_GE(interval.dt_limit_upper, limit * (1 - 1e-9)) << law;
    EXPECT_LT(interval.dt_limit_upper / interval.dt_safe, 1.01) << law;
  }
}

/// Bonds of every touching pair of a cluster thrown together at random speeds.
TEST(Bonds, EnergyAndMomentumOfABreakingCluster) {
  Scene scene = test::scene_of("linear-parallel-bond");
  scene.energy = true;
  scene.boundary.kind = BoundarySpec::Kind::free;
  scene.materials[0].bond_tensile_strength = 2e5, scene.materials[0].bond_shear_strength = 2e5;
  State state = test::cluster(scene, 60, 3, 0.6);
  Engine engine(scene, state);
  engine.bond({.gap = 0.1e-3});
  ASSERT_GT(state.bonds.made, 60u);
  Random random(2);
  Vec3 before{}, after{};
  for (auto& v : state.grains.velocity) {
    v.set(Vec3{random.normal(), random.normal(), random.normal()} * 0.02);
    before += v.vec() * (1 / v.w);
  }
  const auto total = [&] {
    double stored = 0;
    visit_contacts(scene, state, [&](const ContactPoint& p) { stored += p.normal_energy; });
    return engine.kick_sums().kinetic + stored + state.ledger.shear_work;
  };
  const double dt = 1e-8;
  engine.kick(dt), engine.step(dt);
  const double start = total();
  for (int k = 0; k < 20000; ++k) engine.step(dt);
  double scale = 0;
  for (const auto& v : state.grains.velocity) after += v.vec() * (1 / v.w), scale += norm(v.vec()) / v.w;
  EXPECT_NEAR(total() / start, 1, 1e-4);
  EXPECT_LT(norm(after - before), 1e-12 * scale);
  EXPECT_GT(state.bonds.pulled + state.bonds.cut, 5u);
  EXPECT_EQ(state.bonds.made, intact_bonds(state) + state.bonds.pulled + state.bonds.cut);
}

TEST(Bonds, HoldAcrossAnyGapAndThroughAllLists) {
  Scene scene = test::scene_of("linear-parallel-bond");
  auto& m = scene.materials[0];
  m.bond_modulus = 1e4, m.bond_tensile_strength = m.bond_shear_strength = 1e9;
  State state = pair_at(scene, 9.5e-3, 1e-6);
  for (auto* set : {&state.grains.velocity, &state.grains.spin})
    for (auto& v : *set) v.set(Vec3{});
  state.grains.velocity[0].set({-0.4, -0.3, 0}), state.grains.velocity[1].set({0.4, 0.3, 0});
  Engine engine(scene, state);
  engine.bond({});
  const double dt = 1e-6;
  double widest = 0;
  engine.kick(dt);
  for (int k = 0; k < 8000; ++k) {
    engine.step(dt, TallyLevel::none);
    visit_contacts(scene, state, [&](const ContactPoint& p) { widest = std::max(widest, -p.geometry.overlap); });
  }
  EXPECT_EQ(intact_bonds(state), 1u);
  EXPECT_GT(widest, 2 * state.list.skin);
  EXPECT_GT(state.list.builds, 5u);
}

TEST(Bonds, ClustersAreBondedWithinOnly) {
  Scene scene = test::lattice_scene("linear-parallel-bond", "fcc", {4, 4, 4}, 1e-5);
  State whole = test::state_of(scene), parts = test::state_of(scene);
  Engine one(scene, whole), other(scene, parts);
  one.bond({}), other.bond({.gap = 0, .clusters = 8});
  EXPECT_EQ(whole.bonds.made, 6 * whole.grains.size());
  EXPECT_LT(parts.bonds.made, 0.9 * static_cast<double>(whole.bonds.made));
  EXPECT_GT(parts.bonds.made, 0.3 * static_cast<double>(whole.bonds.made));
}

TEST(Friction, VariesAboutItsMeanAndStaysWithItsGrains) {
  for (const bool by_grain : {false, true}) {
    Scene scene = test::lattice_scene("linear", "fcc", {10, 10, 10}, 1e-4);
    scene.contact.friction_deviation = 0.2, scene.contact.friction_by_grain = by_grain;
    State state = test::state_of(scene);
    const Engine engine(scene, state);
    double sum = 0, squares = 0, count = 0;
    visit_contacts(scene, state, [&](const ContactPoint& p) {
      const double mu = p.limit / p.normal.force;
      sum += mu, squares += mu * mu, ++count;
    });
    const double mean = sum / count, deviation = std::sqrt(squares / count - mean * mean);
    const double expected = by_grain ? 0.5 * (1 - 0.2 / std::sqrt(std::numbers::pi)) : 0.5;  // the smaller of two
    EXPECT_NEAR(mean, expected, 3e-3);
    EXPECT_NEAR(deviation, by_grain ? 0.1 * std::sqrt(1 - 1 / std::numbers::pi) : 0.1, 3e-3);
  }
  const FrictionScatter s{0.2, false, 4};
  EXPECT_EQ(friction_factor(s, 3, 8), friction_factor(s, 8, 3));
  EXPECT_NE(friction_factor(s, 3, 8), friction_factor(s, 3, 9));
}

TEST(Friction, OfAPairOfMaterials) {
  Scene scene = test::scene_of("linear");
  scene.materials.push_back(scene.materials[0]);
  scene.materials[0].name = "a", scene.materials[1].name = "b";
  scene.contact.pairs = {{"a", "b", 0.05}};
  EXPECT_EQ(pair_friction(scene), (std::vector{0.5, 0.05, 0.05, 0.5}));
  StageSpec stage;
  stage.material_friction = {0.7, std::nullopt};  // of the first one only: the smaller one of both counts then
  EXPECT_EQ(pair_friction(scene, stage), (std::vector{0.7, 0.5, 0.5, 0.5}));
  stage.friction = 0.2;
  EXPECT_EQ(pair_friction(scene, stage), (std::vector{0.2, 0.2, 0.2, 0.2}));
}

}  // namespace
