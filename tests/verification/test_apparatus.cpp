// Grains between walls that are driven, answer forces or go free: targets, balance, energy, and the step.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <numbers>

#include "app/record.hpp"
#include "assembly/linearise.hpp"
#include "assembly/stiffness.hpp"
#include "base/error.hpp"
#include "boundary/body_control.hpp"
#include "dynamics/run.hpp"
#include "io/scene_file.hpp"
#include "measure/measure_sphere.hpp"
#include "support/hold.hpp"
#include "support/scene_text.hpp"
#include "support/scenes.hpp"
#include "timestep/controller.hpp"
#include "timestep/interval.hpp"

using namespace eg;

namespace {

const std::string grains = test::soft_grains(150);

const std::string smooth =
    "[material.smooth]\nnormal_stiffness = 1e6\nshear_stiffness = 7e5\ndensity = 2650\nfriction = 0\n";
const std::string box = "[boundary]\ntype = \"box\"\n", smooth_box = smooth + box + "wall_material = \"smooth\"\n";
const std::string load = R"(
[[stage]]
name = "load"
local_damping = 0.4
body = { z_high = { stress = 100e3 } }
until = { stress_error = 1e-3, unbalanced_force = 1e-5 }
max_steps = 100000
)";

/// A cylinder of grains: those of a cloud that lie wholly inside, between platens, in a stack of rings.
State cylinder_state(const Scene& scene, double radius, double height) {
  Packing packing, cloud = make_packing(scene);
  packing.dimension = 3, packing.box = {2 * radius, 2 * radius, height};
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vec3 x = cloud.position[i];
    if (std::hypot(x.x - radius, x.y - radius) < radius - cloud.radius[i] && x.z > cloud.radius[i] &&
        x.z < height - cloud.radius[i])
      packing.position.push_back(x), packing.radius.push_back(cloud.radius[i]);
  }
  return make_state(scene, packing);
}

/// A cylinder of radius 8 mm and height 8 mm with `count` rings.
std::string ring_scene(int count) {
  return grains + "[boundary]\ntype = \"free\"\n" +
         "[[boundary.wall]]\nname = \"base\"\npoint = [0, 0, 0]\nnormal = [0, 0, 1]\n"
         "[[boundary.wall]]\nname = \"cap\"\npoint = [0, 0, 8e-3]\nnormal = [0, 0, -1]\n"
         "[[boundary.rings]]\nname = \"ring\"\npoint = [8e-3, 8e-3, 0]\nradius = 8e-3\nheight = 8e-3\nmass = 1e-3\n"
         "count = " +
         std::to_string(count) + "\n" +
         "[[stage]]\nname = \"load\"\nlocal_damping = 0.4\n"
         "body = { cap = { stress = 100e3 }, ring = { free = [\"x\", \"y\"] } }\n"
         "until = { stress_error = 1e-3, unbalanced_force = 1e-5 }\nmax_steps = 100000\n";
}

void run(const Scene& scene, State& state, const RunObserver& observer = {}) {
  Controller controller(scene);
  run_stages(scene, state, controller, observer);
}

TEST(Servo, HoldsItsTargetWithoutOvershoot) {
  for (const int seed : {2, 3, 5}) {
    std::string text = grains;
    text.replace(text.find("seed = 2"), 8, "seed = " + std::to_string(seed));
    const Scene scene =
        parse_scene(text + smooth_box + load +
                        "[[stage]]\nname = \"hold\"\nlocal_damping = 0.4\nbody = { z_high = { stress = 100e3 } }\n" +
                        "until = { steps = 3000 }\n",
                    "a.toml");
    State state = test::state_of(scene);
    double most = 0, worst = 0;
    RunObserver observer;
    observer.step = [&](const State& s, const RunStatus& status) {
      const double stress = body_load(scene, s, drive_of(scene, s, 5)).stress();
      most = std::max(most, stress);
      if (status.stage.name == "hold") worst = std::max(worst, std::abs(stress / 100e3 - 1));
    };
    run(scene, state, observer);
    EXPECT_LT(most, 1.02 * 100e3) << seed;
    EXPECT_LT(worst, 5e-3) << seed;
    EXPECT_NEAR(contact_stress(state)(2, 2), 100e3, 1e-2 * 100e3) << seed;  // inside as on the boundary
  }
}

/// Rough side walls carry a part: inside there is less than on the lid.
TEST(Servo, HoldsTheStressInsideARegion) {
  const std::string stages = R"(
[[stage]]
name = "load"
local_damping = 0.4
body = { z_high = { stress = 100e3REGION } }
until = { stress_error = 3e-3, unbalanced_force = 1e-4 }
max_steps = 200000
)";
  const auto inside_of = [&](const std::string& region) {
    std::string text = grains + box + stages;
    text.replace(text.find("REGION"), 6, region);
    const Scene scene = parse_scene(text, "a.toml");
    State state = test::state_of(scene);
    run(scene, state);
    std::vector<ContactPoint> contacts;
    visit_contacts(scene, state, [&](const ContactPoint& c) { contacts.push_back(c); });
    return measure_sphere(state, contacts, {{5e-3, 5e-3, 4e-3}, 2.5e-3}).stress(2, 2);
  };
  EXPECT_NEAR(inside_of(", region = { centre = [5e-3, 5e-3, 4e-3], radius = 2.5e-3 }"), 100e3, 0.01 * 100e3);
  EXPECT_GT(std::abs(inside_of("") - 100e3), 0.02 * 100e3);
}

TEST(Servo, RegionsAreForStressesAlongANormal) {
  const auto drive = [](const std::string& keys) {
    parse_scene(grains + box + "[[stage]]\nname = \"load\"\nbody = { z_high = { " + keys +
                    ", region = { centre = [0, 0, 0], radius = 1 } } }\nuntil = { steps = 5 }\n",
                "a.toml");
  };
  EXPECT_NO_THROW(drive("stress = 1e5"));
  for (const char* keys : {"force = 10", "velocity = [0, 0, 1]", "stress = 0"}) EXPECT_THROW(drive(keys), InputError);
}

TEST(Servo, UnreachableTargetIsSaid) {
  const Scene scene =
      parse_scene(grains + box +
                      "[[stage]]\nname = \"load\"\nbody = { z_high = { stress = 1e5, max_speed = 1e-6 } }\n"
                      "until = { stress_error = 1e-3 }\nmax_steps = 50\n",
                  "a.toml");
  State state = test::state_of(scene);
  EXPECT_THROW(run(scene, state), RunError);
}

TEST(Servo, NeedsAnAreaForAStress) {
  const Scene scene = parse_scene(
      grains +
          "[boundary]\ntype = \"free\"\n[[boundary.wall]]\nname = \"lid\"\npoint = [0, 0, 1]\nnormal = [0, 0, -1]\n" +
          "[[stage]]\nname = \"load\"\nbody = { lid = { stress = 1e5 } }\nuntil = { steps = 5 }\n",
      "a.toml");
  State state = test::state_of(scene);
  EXPECT_THROW(run(scene, state), InputError);
}

TEST(Rings, ComeIntoBalance) {
  Scene scene = parse_scene(ring_scene(5), "a.toml");
  scene.specimen.count = 480;
  State state = cylinder_state(scene, 8e-3, 8e-3);
  run(scene, state);
  double share = 0;
  int loaded = 0;
  for (std::size_t b = 2; b < state.bodies.size(); ++b)
    if (const Body& ring = state.bodies[b]; ring.magnitude > 0)
      share += std::hypot(ring.force.x, ring.force.y) / ring.magnitude, ++loaded;
  ASSERT_GE(loaded, 3);
  EXPECT_LT(share / loaded, 1e-2);
}

TEST(Ledger, ClosesWithWallsServoAndRings) {
  for (const bool rings : {false, true}) {
    const std::string pull = rings ? "body = { cap = { stress = 300e3 }, ring = { free = [\"x\", \"y\"] } }\n"
                                   : "body = { z_high = { stress = 300e3 }, x_low = { velocity = [0.002, 0, 0] } }\n";
    Scene scene = parse_scene((rings ? ring_scene(5) : grains + box + load) + "[[stage]]\nname = \"more\"\n" + pull +
                                  "local_damping = 0.4\nuntil = { steps = 3000 }\n",
                              "a.toml");
    if (rings) scene.specimen.count = 480;
    State state = rings ? cylinder_state(scene, 8e-3, 8e-3) : test::state_of(scene);
    EnergyTable before;
    RunObserver observer;
    observer.stage_end = [&](const State& s, const StageSpec& stage) {
      if (stage.name == "load") before = energies(scene, s);
    };
    run(scene, state, observer);
    const EnergyTable after = energies(scene, state);
    EXPECT_GT(after.work - before.work, 1e-6);
    EXPECT_NEAR(after.residual, before.residual, 1e-4 * (after.work - before.work)) << rings;
  }
}

TEST(Ledger, WallsThatAreRemovedTakeTheirEnergyAlong) {
  const Scene scene = parse_scene(grains + box + load +
                                      "[[stage]]\nname = \"open\"\nremove = [\"x_low\", \"x_high\"]\n"
                                      "until = { steps = 200 }\n",
                                  "a.toml");
  State state = test::state_of(scene);
  double stored = 0;
  EnergyTable before;
  RunObserver observer;
  observer.stage_end = [&](const State& s, const StageSpec& stage) {
    if (stage.name != "load") return;
    before = energies(scene, s);
    visit_contacts(scene, s, [&](const ContactPoint& p) {
      const auto shut = [&](const char* name) { return scene.boundary.bodies[s.walls[p.wall].body].name == name; };
      if (p.j == no_index && (shut("x_low") || shut("x_high"))) stored += p.normal_energy;
    });
  };
  run(scene, state, observer);
  ASSERT_GT(stored, 0.05 * before.normal);
  EXPECT_NEAR(energies(scene, state).residual, before.residual, 0.02 * stored);
}

TEST(Glue, GrainsMoveWithTheirPlaten) {
  const Scene scene = parse_scene(
      grains + box + load + "[[stage]]\nname = \"shear\"\nglue = [\"z_low\", \"z_high\"]\nlocal_damping = 0.4\n" +
          "body = { z_high = { stress = 100e3, velocity = [0.05, 0, 0] } }\nuntil = { steps = 2000 }\n",
      "a.toml");
  State state = test::state_of(scene);
  run(scene, state);
  ASSERT_GT(state.glued.size(), 10u);
  for (const auto& g : state.glued) {  // the servo has just chosen the velocity of the next step
    const double most = 0.02 * norm(state.bodies[5].velocity);
    EXPECT_LT(norm(state.grains.velocity[g.grain].vec() - state.bodies[g.body].velocity), most);
    EXPECT_EQ(norm(state.grains.spin[g.grain].vec()), 0);
  }
  EXPECT_GT(state.bodies[5].moved.x, 0);
  EXPECT_LT(state.bodies[5].force.x, 0);  // the grains hold it back
  EXPECT_NEAR(body_load(scene, state, drive_of(scene, state, 5)).stress(), 100e3, 2e3);
}

/// The run ends with an error that says so.
void expect_stop(const Scene& scene, const std::string& words) {
  State state = test::state_of(scene);
  try {
    run(scene, state);
    FAIL() << "the run went on";
  } catch (const RunError& e) {
    EXPECT_NE(std::string(e.what()).find(words), std::string::npos) << e.what();
  }
}

TEST(Lost, AGrainThatGoesThroughAWallStopsTheRun) {
  const Scene scene = parse_scene(grains + box +
                                      "[[stage]]\nname = \"crush\"\nbody = { z_high = { velocity = [0, 0, -300] } }\n"
                                      "until = { steps = 20000 }\n",
                                  "a.toml");
  expect_stop(scene, "lost");
}

TEST(Servo, ThatNothingHoldsStopsTheRun) {
  const Scene scene = parse_scene(grains + box + R"(
[[stage]]
name = "push"
remove = ["z_low"]
body = { z_high = { force = 0.1, max_speed = 20 } }
until = { stress_error = 1e-3 }
)",
                                  "a.toml");
  expect_stop(scene, "the servo of z_high runs away");
}

/// Stiffness of the packing with columns for the servo's or the free bodies' directions.
struct Bordered {
  Eigen::MatrixXd k;     ///< grains first, then `directions`
  Eigen::VectorXd mass;  ///< of grains; 0 for bodies
};

struct Direction {
  Index body;
  Vec3 along;
};

Bordered bordered(const Scene& scene, const State& state, const std::vector<Direction>& directions) {
  const Network net = linearise(scene, state);
  const auto dofs = static_cast<Eigen::Index>(total_dofs(net)), extra = static_cast<Eigen::Index>(directions.size());
  Bordered b{Eigen::MatrixXd::Zero(dofs + extra, dofs + extra), Eigen::VectorXd::Zero(dofs + extra)};
  b.k.topLeftCorner(dofs, dofs) = Eigen::MatrixXd(stiffness_matrix(net));
  const auto inverse = inverse_mass_diagonal(net);
  for (Eigen::Index d = 0; d < dofs; ++d) {
    const double w = inverse[static_cast<std::size_t>(d)];
    b.mass(d) = w > 0 ? 1 / w : 1e12;  // glued grains stay
  }
  std::vector<Index> glued(state.grains.size(), no_index);
  for (const auto& g : state.glued) glued[g.grain] = g.body;
  std::size_t s = 0;
  visit_contacts(scene, state, [&](const ContactPoint& p) {
    const Spring& spring = net.springs[s++];
    const Eigen::Matrix3d k = contact_stiffness(spring);
    const Index body_i = glued[p.i];
    const Index body_j = p.j == no_index ? state.walls[p.wall].body : glued[p.j];
    for (Eigen::Index e = 0; e < extra; ++e) {  // Δ = u_j − u_i − …: a body on side j adds along, on side i takes it
      const auto& dir = directions[static_cast<std::size_t>(e)];
      const double sign = (body_j == dir.body ? 1.0 : 0.0) - (body_i == dir.body ? 1.0 : 0.0);
      if (sign == 0) continue;
      const Eigen::Vector3d a = sign * Eigen::Vector3d(dir.along.x, dir.along.y, dir.along.z);
      for (Eigen::Index f = 0; f < extra; ++f) {
        const auto& other = directions[static_cast<std::size_t>(f)];
        const double sf = (body_j == other.body ? 1.0 : 0.0) - (body_i == other.body ? 1.0 : 0.0);
        b.k(dofs + e, dofs + f) += a.dot(k * (sf * Eigen::Vector3d(other.along.x, other.along.y, other.along.z)));
      }
      const auto add = [&](Index grain, ContactSide side) {
        const Eigen::Matrix<double, 6, 1> column = side_matrix(spring, side).transpose() * (k * a);
        const auto width = static_cast<Eigen::Index>(net.dofs_per_grain());
        for (Eigen::Index q = 0; q < width; ++q) {
          const int component = active_components(net)[static_cast<std::size_t>(q)];
          b.k(grain * width + q, dofs + e) += column(component);
          b.k(dofs + e, grain * width + q) += column(component);
        }
      };
      if (body_i == no_index) add(p.i, ContactSide::first);
      if (p.j != no_index && body_j == no_index) add(p.j, ContactSide::second);
    }
  });
  return b;
}

double limit_of(const Eigen::MatrixXd& k, const Eigen::VectorXd& mass) {
  const Eigen::VectorXd root = mass.cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = root.asDiagonal() * k * root.asDiagonal();
  return 2 /
         std::sqrt(
             Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff());
}

/// Largest stable step of a run beside its bodies: servos aim at the forces they feel, so that all is in balance.
double bisected_limit(const Scene& prepared, const State& start, double guess) {
  Scene scene = prepared;
  for (auto& drive : scene.stages[start.stage].bodies)
    if (drive.servo != BodyDrive::Servo::none) {
      drive.target = body_load(scene, start, drive).force;
      drive.servo = BodyDrive::Servo::force;
    }
  const auto grows = [&](double dt) {
    State state = start;
    Random random(2);
    for (auto& v : state.grains.velocity)
      if (v.w > 0) v.set(Vec3{random.normal(), random.normal(), random.normal()} * 1e-7);
    for (auto& w : state.grains.spin) w.set({});
    for (auto& b : state.bodies) b.velocity = {}, b.opening = 0;
    Engine engine(scene, state);
    const BodyControl control(scene, state);
    engine.kick(dt);
    const auto speed = [&] {
      double sum = 0;
      for (const auto& v : state.grains.velocity) sum += dot(v.vec(), v.vec());
      return sum;
    };
    const double before = speed();
    for (int k = 0; k < 6000; ++k) {
      engine.step(dt, TallyLevel::none);
      control.drive(state, dt);
      if (speed() > 1e6 * before) return true;
    }
    return false;
  };
  double low = 0.7 * guess, high = 1.4 * guess;
  while (high / low > 1 + 3e-4) (grows(std::sqrt(low * high)) ? high : low) = std::sqrt(low * high);
  return std::sqrt(low * high);
}

/// At rest at the end of its last stage, far below what bisected_limit() stirs up, and with contacts that hold.
State prepared(Scene scene, State state) {
  scene.stages.back().until_unbalanced = 1e-8, scene.stages.back().until_steps = not_given;
  scene.stages.back().max_steps = 600000;
  run(scene, state);
  state.stage = scene.stages.size() - 1;
  test::hold_all_contacts(state);
  return state;
}

TEST(Step, BesideAServo) {
  // the stiffest contacts are those with the lid: grains of low stiffness under a hard one
  Scene scene = parse_scene(grains + box + load, "a.toml");
  scene.materials.push_back(test::linear_material(2e7, 2e7, 2650, 0.3));
  scene.materials.back().name = "hard";
  State fresh = test::state_of(scene);
  for (auto& w : fresh.walls)
    if (w.body == 5) w.material = 1;
  scene.materials.front().friction = 0.3;
  const State state = prepared(scene, fresh);
  const Bordered b = bordered(scene, state, {{5, {0, 0, 1}}});
  const auto n = b.k.rows() - 1;
  const double slack = 2 / 0.5 * state.bodies[5].stiffness - b.k(n, n);
  const Eigen::MatrixXd k = b.k.topLeftCorner(n, n) + b.k.col(n).head(n) * b.k.row(n).head(n) / slack;
  const double exact = limit_of(k, b.mass.head(n));
  EXPECT_NEAR(bisected_limit(scene, state, exact) / exact, 1, 5e-3);
  const StepInterval interval = step_interval(linearise(scene, state));
  EXPECT_LE(interval.dt_safe, exact * (1 + 1e-9));
  EXPECT_GE(interval.dt_limit_upper, exact * (1 - 1e-9));
}

TEST(Step, BesideFreeRings) {
  Scene scene = parse_scene(ring_scene(3), "a.toml");
  scene.specimen.count = 480;
  for (auto& body : scene.boundary.bodies) body.mass = 2e-5;  // hardly more than a grain: rings matter
  const State state = prepared(scene, cylinder_state(scene, 8e-3, 8e-3));
  std::vector<Direction> directions;
  for (Index ring = 2; ring < 5; ++ring)
    directions.push_back({ring, {1, 0, 0}}), directions.push_back({ring, {0, 1, 0}});
  Bordered b = bordered(scene, state, directions);
  b.mass.tail(6).setConstant(2e-5);
  const Bordered cap = bordered(scene, state, {{1, {0, 0, 1}}});  // the servo, as above
  const auto n = cap.k.rows() - 1;
  const double slack = 2 / 0.5 * state.bodies[1].stiffness - cap.k(n, n);
  b.k.topLeftCorner(n, n) += cap.k.col(n).head(n) * cap.k.row(n).head(n) / slack;
  const double exact = limit_of(b.k, b.mass);
  EXPECT_NEAR(bisected_limit(scene, state, exact) / exact, 1, 5e-3);
  const double run_limit = std::min(step_interval(linearise(scene, state)).dt_safe, body_step_limit(state));
  EXPECT_LE(run_limit, exact * (1 + 1e-9));
}

TEST(Step, BesideGluedLayers) {
  const Scene scene =
      parse_scene(grains + box + load + "[[stage]]\nname = \"glued\"\nglue = [\"z_low\", \"z_high\"]\n" +
                      "body = { z_high = { stress = 100e3 } }\nlocal_damping = 0.4\nuntil = { steps = 2000 }\n",
                  "a.toml");
  const State state = prepared(scene, test::state_of(scene));
  const Bordered b = bordered(scene, state, {{5, {0, 0, 1}}});
  const auto n = b.k.rows() - 1;
  const double slack = 2 / 0.5 * state.bodies[5].stiffness - b.k(n, n);
  const double exact =
      limit_of(b.k.topLeftCorner(n, n) + b.k.col(n).head(n) * b.k.row(n).head(n) / slack, b.mass.head(n));
  EXPECT_NEAR(bisected_limit(scene, state, exact) / exact, 1, 5e-3);
  EXPECT_LE(step_interval(linearise(scene, state)).dt_safe, exact * (1 + 1e-9));
}

}  // namespace
