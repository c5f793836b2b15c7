// Specimens rained in layers, and shaken.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "dynamics/run.hpp"
#include "io/scene_file.hpp"
#include "measure/volume.hpp"
#include "support/scene_text.hpp"
#include "support/scenes.hpp"
#include "timestep/controller.hpp"

using namespace eg;

namespace {

const std::string box = "[boundary]\ntype = \"box\"\n", weight = "gravity = [0, 0, -9.81]\n";

/// A loose cloud under its weight.
Scene scene_with(int count, const std::string& stages) {
  std::string grains = weight + test::soft_grains(count);
  const std::string fraction = "solid_fraction = 0.5\n";
  grains.replace(grains.find(fraction), fraction.size(), "box = [0.012, 0.012, 0.03]\n");
  Scene scene = parse_scene(grains + box + stages, "a.toml");
  scene.materials[0].normal_stiffness = 5e4, scene.materials[0].shear_stiffness = 3.5e4;  // longer steps
  return scene;
}

State run(const Scene& scene, const RunObserver& observer = {}) {
  State state = test::state_of(scene);
  Controller controller(scene);
  run_stages(scene, state, controller, observer);
  return state;
}

double highest(const State& state) {
  double most = 0;
  for (const auto& x : state.grains.position) most = std::max(most, x.z);
  return most;
}

TEST(Layers, GrainsAboveWaitUntilTheirStage) {
  const Scene scene = scene_with(250, R"(
[[stage]]
name = "first"
local_damping = 0.2
held_above = 0.015
until = { time = 0.05 }
[[stage]]
name = "second"
local_damping = 0.3
until = { time = 0.3 }
)");
  const State start = test::state_of(scene);
  std::vector<double> mass(start.grains.size() + 1);
  std::vector<Vec3> from(start.grains.size() + 1);
  for (std::size_t i = 0; i < start.grains.size(); ++i)
    mass[start.grains.id[i]] = start.grains.velocity[i].w, from[start.grains.id[i]] = start.grains.position[i].vec();
  int waited = 0, let_go = 0, fell = 0;
  RunObserver observer;
  observer.stage_end = [&](const State& s, const StageSpec& stage) {
    if (stage.name != "first") return;
    for (std::size_t i = 0; i < s.grains.size(); ++i) {
      const Vec3 x = s.grains.position[i].vec(), before = from[s.grains.id[i]];
      waited += before.z > 0.015 && x.z == before.z;
      let_go += before.z > 0.015 && x.z != before.z;
      fell += x.z < before.z - 1e-3;
    }
  };
  const State end = run(scene, observer);
  EXPECT_GT(waited, 80);
  EXPECT_EQ(let_go, 0);
  EXPECT_GT(fell, 50);
  EXPECT_LT(highest(end), 0.02);  // down with the others
  for (std::size_t i = 0; i < end.grains.size(); ++i) EXPECT_EQ(end.grains.velocity[i].w, mass[end.grains.id[i]]);
  double carried = 0, load = 0;
  for (const auto& b : end.bodies) carried -= b.force.z;
  for (const auto& v : end.grains.velocity) load += 9.81 / v.w;
  EXPECT_NEAR(carried / load, 1, 0.03);
}

TEST(Shaking, AFreeGrainMovesByTheAmplitude) {
  Scene scene = scene_with(1, R"(
[[stage]]
name = "shake"
shake = { acceleration = [0, 0, 20], frequency = 50 }
until = { time = 0.1 }
)");
  scene.gravity = {};
  double start = 0, most = 0;
  RunObserver observer;
  observer.step = [&](const State& s, const RunStatus&) {
    const double z = s.grains.position[0].z;
    if (s.step == 1) start = z;
    most = std::max(most, std::abs(z - start));
  };
  const State end = run(scene, observer);
  const double amplitude = 2 * 20 / std::pow(2 * std::numbers::pi * 50, 2);  // of 1 − cos
  EXPECT_NEAR(most, amplitude, 0.02 * amplitude);
  EXPECT_NEAR(end.grains.position[0].z, start, 0.03 * amplitude);  // five whole periods
}

TEST(Shaking, TappingDensifies) {
  const Scene scene = scene_with(250, R"(
[[stage]]
name = "rain"
friction = 1
local_damping = 0.3
until = { time = 0.1 }
[[stage]]
name = "tap"
local_damping = 0.1
shake = { acceleration = [0, 0, 30], frequency = 100 }
until = { time = 0.1 }
[[stage]]
name = "rest"
local_damping = 0.3
until = { time = 0.03 }
)");
  double loose = 0;
  RunObserver observer;
  const auto centre = [](const State& s) {
    double sum = 0, mass = 0;
    for (std::size_t i = 0; i < s.grains.size(); ++i)
      sum += s.grains.position[i].z / s.grains.velocity[i].w, mass += 1 / s.grains.velocity[i].w;
    return sum / mass;
  };
  observer.stage_end = [&](const State& s, const StageSpec& stage) {
    if (stage.name == "rain") loose = centre(s);
  };
  const State end = run(scene, observer);
  EXPECT_LT(centre(end), 0.98 * loose);
}

TEST(Shaking, NeedsAContainer) {
  const std::string head = test::soft_grains(20) + "[boundary]\ntype = \"periodic\"\n[[stage]]\nname = \"s\"\n";
  for (const char* key : {"held_above = 0.01\n", "shake = { acceleration = [0, 0, 1], frequency = 50 }\n"})
    EXPECT_THROW(parse_scene(head + key + "until = { steps = 5 }\n", "a.toml"), InputError);
  EXPECT_THROW(parse_scene(test::soft_grains(20) + box +
                               "[[stage]]\nname = \"s\"\nshake = { acceleration = [0, 0, 1], frequency = -5 }\n"
                               "until = { steps = 5 }\n",
                           "a.toml"),
               InputError);
}

}  // namespace
