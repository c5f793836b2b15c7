// policy = "certified" in a run: the step is held against the exact limit of the states met, computed afresh.
#include <gtest/gtest.h>

#include <cstdio>
#include <map>

#include "assembly/linearise.hpp"
#include "dynamics/run.hpp"
#include "io/scene_file.hpp"
#include "state/damping.hpp"
#include "support/scenes.hpp"
#include "timestep/controller.hpp"
#include "timestep/damped_interval.hpp"

namespace eg {
namespace {

constexpr const char* text = R"(
title = "steps"
dimension = 3
seed = 5
[material.quartz]
shear_modulus = 29e9
poisson = 0.12
density = 2650
friction = 0.25
[contact]
law = "hertz-mindlin"
[specimen]
source = "cloud"
count = 300
grading = { min_radius = 1e-3, max_radius = 2e-3 }
solid_fraction = 0.5
[boundary]
type = "periodic"
[damping]
local = 0.4
[timestep]
policy = "certified"
safety = 0.9
[[stage]]
name = "soft"
friction = 0.1
stress = { isotropic = 1e3 }
max_strain_rate = 5
until = { stress_error = 1e-1, unbalanced_force = 1e-1 }
[[stage]]
name = "stiff"
stress = { isotropic = 10e6 }
max_strain_rate = 5
until = { stress_error = 1e-1, unbalanced_force = 1e-1 }
[[stage]]
name = "shear"
strain_rate = { z = 5 }
hold = { mean_stress = 10e6, equal = ["x", "y"] }
until = { axial_strain = 0.05 }
)";

struct Share {
  double largest = 0, sum = 0;
  int count = 0;
};

TEST(Controller, StaysBelowTheExactLimitAndNearIt) {
  const Scene scene = parse_scene(text, "steps.toml");
  State state = test::state_of(scene);
  Controller controller(scene);
  std::map<std::string, Share> shares;
  RunObserver observer;
  observer.step = [&](const State& s, const RunStatus& status) {
    if (s.step % 97 != 0) return;
    const Network net = linearise(scene, s);
    const double limit = damped_interval(net, damping_in_force(scene, s), step_interval(net)).dt_limit_upper;
    if (std::isinf(limit)) return;
    Share& share = shares[status.stage.name];
    share.largest = std::max(share.largest, s.dt / limit);
    share.sum += s.dt / limit;
    ++share.count;
  };
  ASSERT_TRUE(run_stages(scene, state, controller, observer));
  for (const auto& [name, share] : shares) {
    std::printf("%-8s dt over limit: mean %.3f, largest %.3f, at %d instants\n", name.c_str(), share.sum / share.count,
                share.largest, share.count);
    EXPECT_LE(share.largest, 1) << name;
  }
  EXPECT_GE(shares["stiff"].sum, 0.85 * scene.timestep.safety * shares["stiff"].count);
  EXPECT_GE(shares["shear"].sum, 0.85 * scene.timestep.safety * shares["shear"].count);
  std::printf("%llu evaluations in %llu steps\n", static_cast<unsigned long long>(controller.log().all_evaluations()),
              static_cast<unsigned long long>(state.step));
}

}  // namespace
}  // namespace eg
