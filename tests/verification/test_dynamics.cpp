// The explicit solver against exact results and conservation laws.
#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <numbers>

#include "assembly/linearise.hpp"
#include "boundary/cell_control.hpp"
#include "contact/laws.hpp"
#include "dynamics/engine.hpp"
#include "state/gather.hpp"
#include "support/scenes.hpp"
#include "timestep/interval.hpp"

using namespace eg;

namespace {

/// Kinetic energy at the time of the last forces plus stored energy plus what was dissipated minus work done from
/// outside.
double energy_balance(const Scene& scene, const State& state, const Engine& engine) {
  double stored = 0;
  visit_contacts(scene, state, [&](const ContactPoint& p) { stored += p.normal_energy; });
  const auto& e = state.ledger;
  return engine.kick_sums().kinetic + stored + e.shear_work + e.local_damping + e.mass_damping + e.viscous_damping -
         e.boundary - e.body;
}

State two_spheres(const Scene& scene, double radius, double speed, Vec3 direction) {
  Packing p;
  p.box = {1, 1, 1};
  direction *= 1 / norm(direction);
  p.position = {Vec3{}, direction * (2 * radius * (1 + 1e-9))};
  p.radius = {radius, radius};
  Scene free = scene;
  free.boundary.kind = BoundarySpec::Kind::free;
  State s = make_state(free, p);
  s.grains.velocity[0].set(direction * (0.5 * speed));
  s.grains.velocity[1].set(direction * (-0.5 * speed));
  return s;
}

TEST(Collision, HertzSpheresHeadOn) {
  Scene scene = test::scene_of("hertz-mindlin");
  scene.materials = {test::hertz_material(80e9, 0.3, 7800)};
  State state = two_spheres(scene, 0.496e-3, 1.0, {1, 0, 0});
  Engine engine(scene, state);
  const double dt = 1e-9;
  engine.kick(dt);
  double deepest = 0, begin = 0, end = 0;
  for (int k = 0; k < 6000; ++k) {
    const double before = 2 * 0.496e-3 - norm(state.grains.position[1].vec() - state.grains.position[0].vec());
    engine.step(dt);
    const double overlap = 2 * 0.496e-3 - norm(state.grains.position[1].vec() - state.grains.position[0].vec());
    deepest = std::max(deepest, overlap);
    if (before <= 0 && overlap > 0) begin = state.time - dt * overlap / (overlap - before);
    if (before > 0 && overlap <= 0) end = state.time + dt * overlap / (before - overlap);
  }
  EXPECT_NEAR(deepest, 1.0151745e-6, 2e-6 * 1.0151745e-6);
  EXPECT_NEAR(end - begin, 2.9879379e-6, 2e-5 * 2.9879379e-6);
  EXPECT_NEAR(norm(state.grains.velocity[0].vec()), 0.5, 1e-6);
}

TEST(Momentum, ConservedToRoundOffInACollidingCluster) {
  for (const auto& law : law_names())
    for (const int dimension : {2, 3}) {
      Scene scene = test::scene_of(law, dimension);
      scene.damping.normal_ratio = 0.1, scene.damping.shear_ratio = 0.1;
      State state = test::cluster(scene, 200, 5, 0.8);
      Random random(1);
      for (auto& v : state.grains.velocity)
        v.x += random.normal(), v.y += random.normal(), v.z += dimension == 3 ? random.normal() : 0;
      Engine engine(scene, state);
      const auto sums = [&] {
        std::array<Vec3, 2> s{};
        double scale = 0, turn_scale = 0;
        for (std::size_t i = 0; i < state.grains.size(); ++i) {
          const auto& g = state.grains;
          const double m = 1 / g.velocity[i].w;
          s[0] += g.velocity[i].vec() * m;
          // position at the time of the velocity, half a step back
          const Vec3 arm = g.position[i].vec() + g.velocity[i].vec() * (0.5 * state.dt);
          s[1] += cross(arm, g.velocity[i].vec()) * m + g.spin[i].vec() * (1 / g.spin[i].w);
          scale += m * norm(g.velocity[i].vec()), turn_scale += m * norm(arm) * norm(g.velocity[i].vec());
        }
        return std::make_tuple(s[0], s[1], scale, turn_scale);
      };
      const double dt = 2e-8;
      engine.kick(dt);
      const auto [p0, l0, scale0, turn0] = sums();
      for (int k = 0; k < 500; ++k) engine.step(dt);
      const auto [p1, l1, scale1, turn1] = sums();
      EXPECT_LT(norm(p1 - p0), 1e-13 * scale1) << law;
      EXPECT_LT(norm(l1 - l0), 1e-12 * turn1) << law;  // contact points in the middle of the overlap: exact
    }
}

/// A cloud pressed to 100 kPa, at rest. A spring without memory never lets a packing come to rest: the cumulative one
/// does it in its stead.
State pressed(Scene scene, double dt, double unbalanced) {
  if (scene.contact.law == "linear-incremental") scene.contact.law = "linear";
  State state = test::state_of(scene);
  StageSpec stage;
  for (std::size_t k = 0; k < 3; ++k) stage.control[k] = {ComponentControl::Kind::stress, 1e5};
  stage.max_strain_rate = 30;
  Engine engine(scene, state);
  engine.set_local_damping(0.7);
  engine.kick(dt);
  const CellControl control(stage, state, scene.materials[0].density);
  do {
    engine.step(dt);
    control.set_rate(state, dt);
  } while (stress_error(state, stage) > 1e-4 || engine.unbalanced_ratio() > unbalanced);
  return state;
}

class Ledger : public ::testing::TestWithParam<std::string> {};

TEST_P(Ledger, ClosesInACompression) {
  const std::string law = GetParam();
  Scene scene = test::scene_of(law);
  scene.energy = true;
  scene.damping.local = 0.2, scene.damping.normal_ratio = 0.05, scene.damping.shear_ratio = 0.05,
  scene.damping.mass = 10;
  const bool simple = law == "linear" || law == "hertz-mindlin" || law == "hertz-mindlin-rescale";
  scene.specimen.count = simple ? 300 : 120, scene.specimen.grading.min_radius = 0.8e-3,
  scene.specimen.grading.max_radius = 1.2e-3;
  scene.specimen.grading.kind = Grading::Kind::uniform;
  scene.specimen.solid_fraction = 0.55;
  State state = pressed(scene, simple ? 3e-7 : 2e-7, 1e-3);
  state.ledger = {};
  // So few grains may collapse on the way, and the error of leapfrog with curved springs, which falls with the square
  // of the step, must stay small then too.
  const double dt = simple ? 3e-7 : 5e-8;
  Engine engine(scene, state);
  state.cell.rate = Mat3{};
  engine.step(dt);
  const double start = energy_balance(scene, state, engine);
  state.cell.rate(0, 0) = state.cell.rate(1, 1) = state.cell.rate(2, 2) = -1;
  while (contact_stress(state)(0, 0) < 1e6) engine.step(dt);
  const auto& e = state.ledger;
  const double residual = energy_balance(scene, state, engine) - start;
  RecordProperty(law, std::to_string(residual / e.boundary));
  // a spring without memory is a dashpot: its force lags by half a step
  EXPECT_LT(std::abs(residual), (law == "linear-incremental" ? 1e-5 : 1e-6) * e.boundary)
      << law << " work " << e.boundary;
  EXPECT_GT(e.friction, law == "linear-incremental" ? 0 : 1e-5 * e.boundary) << law;
  for (const double part : {e.local_damping, e.viscous_damping}) EXPECT_GT(part, 1e-5 * e.boundary) << law;
}

/// Grains thrown into each other's way, bonded where the law has bonds, burst apart with friction, rotation and
/// dashpots: the largest residual on the way [J].
double residual_of_burst(const std::string& law, double dt) {
  Scene scene = test::scene_of(law);
  scene.energy = true;
  scene.damping.normal_ratio = scene.damping.shear_ratio = 0.1;
  scene.materials[0].bond_tensile_strength = scene.materials[0].bond_shear_strength = 1e30;
  State state = test::cluster(scene, 60, 1, 0.8);
  Random random(1);
  for (auto& v : state.grains.velocity) v.set(Vec3{random.normal(), random.normal(), random.normal()} * 0.3);
  Engine engine(scene, state);
  if (law == "linear-parallel-bond") engine.bond({.gap = 0.1e-3});
  engine.kick(0.5 * dt);
  engine.step(dt);
  const double start = energy_balance(scene, state, engine);
  double most = 0;
  while (state.time < 20e-6) {
    engine.step(dt);
    most = std::max(most, std::abs(energy_balance(scene, state, engine) - start));
  }
  EXPECT_GT(state.ledger.friction + state.ledger.viscous_damping, 100 * most) << law;
  return most;
}

TEST_P(Ledger, ResidualFallsWithTheSquareOfTheStep) {
  const double coarse = residual_of_burst(GetParam(), 2e-8), fine = residual_of_burst(GetParam(), 1e-8);
  RecordProperty(GetParam(), std::to_string(coarse / fine));
  EXPECT_GT(coarse, (GetParam() == "linear-incremental" ? 1.8 : 3.5) * fine);  // a dashpot's lag, as above
}

INSTANTIATE_TEST_SUITE_P(Laws, Ledger, ::testing::ValuesIn(law_names()), [](const auto& info) {
  std::string name = info.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(Invariance, TranslationAndRotationOfTheFrame) {
  const Scene scene = test::scene_of("hertz-mindlin");
  const State start = test::cluster(scene, 60, 9, 0.9);
  const double c = std::cos(0.7), s = std::sin(0.7);
  Mat3 r = Mat3::identity();
  r(0, 0) = c, r(0, 1) = -s, r(1, 0) = s, r(1, 1) = c;
  const Vec3 shift{0.4e-3, -0.1e-3, 0.25e-3}, ride{0.5, -0.3, 0.1};
  const auto travel = [&](State state) {
    Engine engine(scene, state);
    engine.kick(2e-8);
    for (int k = 0; k < 100; ++k) engine.step(2e-8);
    return state;
  };
  const State plain = travel(start);
  State turned_start = start;
  for (std::size_t i = 0; i < start.grains.size(); ++i) {
    turned_start.grains.position[i].set(r * start.grains.position[i].vec() + shift);
    turned_start.grains.velocity[i].set(ride);
  }
  const State turned = travel(turned_start);
  std::vector<Vec3> by_id(start.grains.size() + 1);
  for (std::size_t i = 0; i < plain.grains.size(); ++i) by_id[plain.grains.id[i]] = plain.grains.position[i].vec();
  double moved = 0;
  for (std::size_t i = 0; i < turned.grains.size(); ++i) {
    const Vec3 expected = r * by_id[turned.grains.id[i]] + shift + ride * turned.time;
    EXPECT_LT(norm(turned.grains.position[i].vec() - expected), 1e-12 * 1e-3 * 100);
    moved = std::max(moved, norm(by_id[turned.grains.id[i]] - start.grains.position[turned.grains.id[i] - 1].vec()));
  }
  EXPECT_GT(moved, 1e-6);
}

State sheared(const Scene& scene, int threads, bool scalar) {
  omp_set_num_threads(threads);
  State state = test::state_of(scene);
  Engine engine(scene, state, scalar);
  state.cell.rate(0, 0) = state.cell.rate(1, 1) = state.cell.rate(2, 2) = -300;
  state.cell.rate(0, 1) = 200;
  engine.kick(1e-7);
  for (int k = 0; k < 400; ++k) engine.step(1e-7);
  return state;
}

TEST(Determinism, OneAndTwoThreadsAgreeBitForBit) {
  Scene scene = test::lattice_scene("hertz-mindlin", "fcc", {9, 9, 9}, 0.03);
  scene.specimen.radius_scatter = 0.01;
  const State a = sheared(scene, 1, false), b = sheared(scene, 2, false), c = sheared(scene, 2, true);
  ASSERT_GT(a.virial(0, 0), 0);
  for (std::size_t i = 0; i < a.grains.size(); ++i) {
    ASSERT_EQ(a.grains.position[i].x, b.grains.position[i].x);
    ASSERT_EQ(a.grains.velocity[i].y, b.grains.velocity[i].y);
    ASSERT_EQ(a.grains.spin[i].z, b.grains.spin[i].z);
  }
  EXPECT_EQ(a.virial(0, 1), b.virial(0, 1));
  EXPECT_NEAR(c.virial(0, 0), a.virial(0, 0), 1e-9 * a.virial(0, 0));  // the scalar reference loop
}

TEST(Wall, GrainRestsUnderGravity) {
  Scene scene = test::scene_of("linear");
  scene.gravity = {0, 0, -9.81};
  scene.damping.normal_ratio = 0.5;
  scene.boundary.kind = BoundarySpec::Kind::free;
  scene.energy = true;
  Packing p;
  p.position = {{0, 0, 1e-3}};
  p.radius = {1e-3};
  State state = make_state(scene, p);
  test::add_plane(state, {}, {0, 0, 1});
  Engine engine(scene, state);
  engine.kick(1e-6);
  for (int k = 0; k < 100000; ++k) engine.step(1e-6);
  const double weight = 9.81 / state.grains.velocity[0].w;
  EXPECT_NEAR(state.bodies[0].force.z, -weight, 1e-9 * weight);
  EXPECT_NEAR(state.grains.position[0].z, 1e-3 - weight / 1e6, 1e-15);
  // all of the potential energy went into the dashpot and the spring
  // (the weight sets in at once, which the trapezoidal rule sees as half a step)
  EXPECT_NEAR(state.ledger.body, state.ledger.viscous_damping + 0.5 * weight * weight / 1e6, 1e-5 * state.ledger.body);
}

/// Largest stable step of the solver itself: a faint random motion about the state either stays faint or grows.
double bisected_limit(const Scene& scene, const State& start, double guess) {
  const auto grows = [&](double dt) {
    State state = start;
    Random random(2);
    const double faint = 1e-9;  // m/s
    for (auto& v : state.grains.velocity)
      v.x = faint * random.normal(), v.y = faint * random.normal(),
      v.z = scene.dimension == 3 ? faint * random.normal() : 0;
    Engine engine(scene, state);
    engine.kick(dt);
    const double before = engine.kick_sums().kinetic + 1e-300;
    for (int k = 0; k < 1200; ++k) {
      engine.step(dt, TallyLevel::none);
      double kinetic = 0;
      for (const auto& v : state.grains.velocity) kinetic += 0.5 / v.w * dot(v.vec(), v.vec());
      if (kinetic > 1e8 * before) return true;
    }
    return false;
  };
  double low = 0.5 * guess, high = 2 * guess;
  while (high / low > 1 + 2e-4) (grows(std::sqrt(low * high)) ? high : low) = std::sqrt(low * high);
  return std::sqrt(low * high);
}

struct LatticeLimit {
  std::string lattice;
  std::array<int, 3> cells;
  double with, without;  // Δt/√(m/k), kn = kt
};

class Stability : public ::testing::TestWithParam<LatticeLimit> {};

TEST_P(Stability, BisectedStepEqualsTwoOverOmega) {
  const auto& c = GetParam();
  for (const bool rotation : {true, false}) {
    Scene scene = test::lattice_scene("linear", c.lattice, c.cells, 1e-4);
    scene.rotation = rotation;
    scene.materials = {test::linear_material(1e6, 1e6, 2650, 1e3)};
    const State start = test::state_of(scene);
    const double exact = (rotation ? c.with : c.without) * std::sqrt(1 / start.grains.velocity[0].w / 1e6);
    EXPECT_NEAR(bisected_limit(scene, start, exact) / exact, 1.0, 2e-3)
        << c.lattice << (rotation ? " with" : " without") << " rotation";
  }
}

INSTANTIATE_TEST_SUITE_P(Lattices, Stability,
                         ::testing::Values(LatticeLimit{"fcc", {4, 4, 4}, .3162278, .5},
                                           LatticeLimit{"bcc", {4, 4, 4}, .3872983, .5},
                                           LatticeLimit{"sc", {4, 4, 4}, .4472136, .5773503},
                                           LatticeLimit{"hexagonal", {12, 6, 1}, .4082483, .6666667},
                                           LatticeLimit{"square", {6, 6, 1}, .5, .7071068}),
                         [](const auto& info) { return info.param.lattice; });

/// Growth of the difference of two runs, one of them faintly disturbed: the linear response of the solver about its own
/// motion, whatever forces are still unbalanced.
bool difference_grows(const Scene& scene, const State& start, double dt) {
  State a = start, b = start;
  Random random(3);
  for (auto& v : b.grains.velocity) v.set(v.vec() + Vec3{random.normal(), random.normal(), random.normal()} * 1e-10);
  Engine run_a(scene, a), run_b(scene, b);
  const auto difference = [&] {
    double sum = 0;
    for (std::size_t i = 0; i < a.grains.size(); ++i) {
      const Vec3 d = a.grains.velocity[i].vec() - b.grains.velocity[i].vec();
      sum += dot(d, d) / a.grains.velocity[i].w;
    }
    return std::sqrt(sum);
  };
  const double before = difference();
  // An unstable step multiplies by 1 + 2√(2ε) at ε above the limit; a packing that its own weight of forces bends grows
  // too, a hundred times slower, and must not be taken for it.
  // A spring without memory is a dashpot: 1 + 2ε only.
  const int steps = scene.contact.law == "linear-incremental" ? 4000 : 500;
  for (int k = 0; k < steps; ++k) {
    run_a.step(dt, TallyLevel::none), run_b.step(dt, TallyLevel::none);
    if (k % 10 == 0 && !(difference() < 1e4 * before)) return true;
  }
  return false;
}

TEST(Stability, BisectedStepEqualsTwoOverOmegaOnRandomPackings) {
  for (const auto& law : law_names())
    for (std::uint64_t seed = 1; seed <= (law == "linear" || law == "hertz-mindlin" ? 3 : 1); ++seed) {
      Scene scene = test::scene_of(law);
      scene.materials[0].rolling_friction = 1e3;
      scene.materials[0].bond_tensile_strength = scene.materials[0].bond_shear_strength = 1e12;
      scene.seed = seed;
      scene.specimen.count = 100, scene.specimen.solid_fraction = 0.5;
      scene.specimen.grading.kind = Grading::Kind::uniform;
      scene.specimen.grading.min_radius = 0.8e-3, scene.specimen.grading.max_radius = 1.2e-3;
      Scene pressing = scene;  // what stands without friction stands without a memory of shear
      if (law == "linear-incremental") pressing.materials[0].friction = 0;
      State start = pressed(pressing, 3e-7, 1e-4);
      for (auto* set : {&start.grains.velocity, &start.grains.spin})
        for (auto& v : *set) v.set(Vec3{});
      start.cell.rate = Mat3{};
      start.friction = {1e3};  // from here on every contact sticks, as the eigenvalue assumes
      fit_rotation(scene, start);
      Engine made(scene, start);  // contacts of this law, where those at hand are of another
      if (law == "linear-parallel-bond") made.bond({});
      const StepInterval exact = step_interval(linearise(scene, start));
      ASSERT_LT(exact.dt_limit_upper / exact.dt_safe, 1 + 1e-6);
      start.dt = exact.dt_safe;
      double low = 0.9, high = 1.1;
      while (high - low > 5e-4) {
        const double middle = 0.5 * (low + high);
        State at = start;
        at.dt = middle * exact.dt_safe;
        (difference_grows(scene, at, at.dt) ? high : low) = middle;
      }
      EXPECT_NEAR(0.5 * (low + high), 1.0, 2e-3) << law << " seed " << seed;
    }
}

}  // namespace
