// Stages that change their grains: friction that falls to a density, radii that grow.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "base/error.hpp"
#include "boundary/cell_control.hpp"
#include "dynamics/run.hpp"
#include "io/scene_file.hpp"
#include "io/snapshot.hpp"
#include "measure/homogenised.hpp"
#include "specimen/grading.hpp"
#include "state/grain_mass.hpp"
#include "support/scenes.hpp"
#include "timestep/controller.hpp"

using namespace eg;

namespace {

/// 200 equal spheres; `more` is added to the specimen, `stages` follow.
Scene scene_with(const std::string& more, const std::string& stages, const std::string& boundary = "periodic") {
  return parse_scene(R"(
dimension = 3
seed = 3
contact.law = "hertz-mindlin"
damping.local = 0.3
material.quartz = { shear_modulus = 29e9, poisson = 0.12, density = 2650, friction = 0.25 }
boundary.type = ")" + boundary +
                         R"("
[specimen]
source = "cloud"
count = 200
grading = { min_radius = 0.9e-4, max_radius = 1.1e-4 }
)" + more + stages,
                     "preparation.toml");
}

struct Ran {
  State state;
  ControllerLog log;
};

Ran run(const Scene& scene, State state, std::uint64_t until = ~std::uint64_t{0}) {
  Controller controller(scene);
  RunObserver observer;
  std::uint64_t now = state.step;
  observer.step = [&](const State& s, const RunStatus&) { now = s.step; };
  observer.stop = [&] { return now >= until; };
  run_stages(scene, state, controller, observer);
  return {std::move(state), controller.log()};
}
State run(const Scene& scene) { return run(scene, test::state_of(scene)).state; }

double void_ratio_of(const Scene& scene, const State& state) { return homogenise(scene, state).void_ratio; }

std::string schedule(const std::string& friction) {
  return "[[stage]]\nname = \"compress\"\nfriction = " + friction +
         "\nstress = { isotropic = 100e3 }\nmax_strain_rate = 100\nuntil = { stress_error = 0.01, unbalanced_force = "
         "5e-3 }\n";
}

TEST(Preparation, FrictionFallsUntilTheVoidRatioIsMet) {
  double fallen = 1;
  for (const char* target : {"0.68", "0.62"}) {
    const Scene scene =
        scene_with("solid_fraction = 0.5\n", schedule(std::string("{ start = 0.5, void_ratio = ") + target + " }") +
                                                 "[[stage]]\nname = \"rest\"\nstress = { isotropic = 100e3 }\n"
                                                 "until = { steps = 2000, stress_error = 0.01 }\n");
    State state = test::state_of(scene);
    Controller controller(scene);
    RunObserver observer;
    double least = 1, met = 0;
    observer.step = [&](const State& s, const RunStatus&) {
      if (s.stage == 0 && !s.friction.empty()) least = std::min(least, s.friction.front());
    };
    observer.stage_end = [&](const State& s, const StageSpec& stage) {
      if (stage.name != "compress") return;
      met = void_ratio_of(scene, s);
      EXPECT_EQ(s.friction.front(), 0.5);
    };
    run_stages(scene, state, controller, observer);
    EXPECT_NEAR(met, std::stod(target), 3e-3);
    EXPECT_NEAR(void_ratio_of(scene, state), std::stod(target), 5e-3);  // at the friction of the material
    EXPECT_EQ(state.friction.front(), 0.25);
    EXPECT_LT(least, fallen);  // denser: lower
    fallen = least;
  }
}

std::string failure(const Scene& scene) {
  try {
    run(scene);
  } catch (const RunError& e) {
    return e.what();
  }
  return "no error";
}

TEST(Preparation, SaysInOneLineWhatCannotBeReached) {
  const auto error = [](const std::string& friction) {
    return failure(scene_with("solid_fraction = 0.5\n", schedule(friction)));
  };
  const std::string loose = error("{ start = 0.5, void_ratio = 0.95 }");
  EXPECT_TRUE(loose.starts_with("stage \"compress\": void ratio 0.95 cannot be reached: the packing at rest has 0."))
      << loose;
  EXPECT_TRUE(loose.ends_with("already with friction.start = 0.5; begin with more friction, or aim lower")) << loose;
  const std::string dense = error("{ start = 0.02, void_ratio = 0.4 }");
  EXPECT_TRUE(dense.starts_with("stage \"compress\": void ratio 0.4 cannot be reached: the packing at rest has 0."))
      << dense;
  EXPECT_TRUE(dense.ends_with("without any friction; aim higher")) << dense;
  EXPECT_EQ(loose.find('\n'), std::string::npos);
}

TEST(Preparation, FrictionFallsUntilTheStressIsMetInACellThatStays) {
  Scene scene = scene_with("solid_fraction = 0.5\n",
                           "[[stage]]\nname = \"compress\"\nfriction = 0.5\nstress = { isotropic = 400e3 }\n"
                           "max_strain_rate = 100\nuntil = { stress_error = 0.01, unbalanced_force = 5e-3 }\n"
                           "[[stage]]\nname = \"fall\"\nfriction = { start = 0.5, mean_stress = 200e3 }\n"
                           "until = { unbalanced_force = 5e-3 }\n");
  scene.materials[0].shear_modulus =
      29e7;  // in so small a cell of hard grains any rearrangement releases the whole stress
  const State state = run(scene);
  EXPECT_NEAR(mean_stress(state) / 200e3, 1, 0.03);
  EXPECT_TRUE(state.preparation.met);
}

const std::string growing =
    "[[stage]]\nname = \"grow\"\nfriction = 0.1\nradius_growth = 60\nuntil = { steps = 1000 }\n";

TEST(Preparation, RadiiGrowToTheirSizesInTheBoxGiven) {
  const Scene scene = scene_with("solid_fraction = 0.4\nexpand_to = 0.65\n", growing);
  const State start = test::state_of(scene);
  EXPECT_NEAR(homogenise(scene, start).solid_fraction, 0.4, 1e-12);
  const auto [state, log] = run(scene, start);
  const Homogenised h = homogenise(scene, state);
  EXPECT_NEAR(h.solid_fraction, 0.65, 1e-12);
  EXPECT_EQ(state.preparation.size, 1);
  EXPECT_GT(mean_stress(state), 0);
  EXPECT_LT(log.worst_true, 1.0) << "a step that was proved was too large";
  Random random(scene.seed);
  const auto radii = draw_radii(scene.specimen.grading, 3, 200, random);
  for (std::size_t i = 0; i < 200; ++i) {
    const double r = state.grains.radius(i);
    EXPECT_NEAR(r / radii[state.grains.id[i] - 1], 1, 1e-12);
    const auto [mass, inertia] = grain_mass(3, 2650, r);
    EXPECT_NEAR(state.grains.velocity[i].w * mass, 1, 1e-12);
    EXPECT_NEAR(state.grains.spin[i].w * inertia, 1, 1e-12);
  }
}

TEST(Preparation, RadiiGrowBetweenWalls) {
  const Scene scene = scene_with("solid_fraction = 0.4\nexpand_to = 0.6\n", growing, "box");
  const State state = run(scene);
  EXPECT_EQ(state.preparation.size, 1);
  EXPECT_NEAR(homogenise(scene, state).solid_fraction, 0.6, 1e-12);
}

TEST(Preparation, GoesOnBitForBit) {
  const Scene scene =
      scene_with("solid_fraction = 0.4\nexpand_to = 0.55\n", growing + schedule("{ start = 0.3, void_ratio = 0.63 }"));
  const State start = test::state_of(scene), whole = run(scene, start).state;
  const auto path = std::filesystem::temp_directory_path() / ("eigengrain_prep_" + std::to_string(::getpid()) + ".h5");
  for (const double share : {0.05, 0.5, 0.9}) {
    write_snapshot(path.string(), scene,
                   run(scene, start, static_cast<std::uint64_t>(share * static_cast<double>(whole.step))).state);
    const State end = run(scene, read_snapshot(path.string()).state).state;
    std::filesystem::remove(path);
    ASSERT_EQ(end.step, whole.step) << share;
    EXPECT_EQ(end.virial.a, whole.virial.a);
    EXPECT_EQ(end.friction, whole.friction);
    for (std::size_t i = 0; i < 200; ++i) ASSERT_EQ(end.grains.position[i].x, whole.grains.position[i].x);
  }
}

}  // namespace
