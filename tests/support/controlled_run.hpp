#pragma once
// policy = "certified" in a run, held against the limit of the states that it meets, worked out afresh.
#include <fmt/format.h>

#include <chrono>
#include <string>
#include <vector>

#include "assembly/linearise.hpp"
#include "io/scene_file.hpp"
#include "specimen/make_packing.hpp"
#include "specimen/make_state.hpp"
#include "state/damping.hpp"
#include "support/scene_text.hpp"
#include "timestep/controller.hpp"
#include "timestep/damped_interval.hpp"

namespace eg::test {

/// Gathered at 1 kPa, squeezed to 10 MPa.
inline constexpr const char* squeeze = R"(
[[stage]]
name = "gather"
friction = 0.1
stress = { isotropic = 1e3 }
max_strain_rate = 50
until = { stress_error = 1e-2, unbalanced_force = 1e-2 }
[[stage]]
name = "squeeze"
stress = { isotropic = 10e6 }
max_strain_rate = 5
until = { stress_error = 1e-2, unbalanced_force = 1e-2 }
)";

/// Drained triaxial compression at 100 kPa to 10 % of strain.
inline constexpr const char* triaxial = R"(
[[stage]]
name = "press"
friction = 0.1
stress = { isotropic = 100e3 }
max_strain_rate = 50
until = { stress_error = 1e-2, unbalanced_force = 1e-2 }
[[stage]]
name = "triaxial"
strain_rate = { axis = "z", inertial_number = 1e-3 }
stress = { x = 100e3, y = 100e3 }
until = { axial_strain = 0.1 }
)";

/// Quartz spheres, radii 1:2, as a cloud that the stages compress; `damping`: the line of [damping].
inline Scene controlled_scene(std::size_t grains, const char* stages, const std::string& damping = "local = 0.2") {
  return parse_scene("title = \"certified step\"\ndimension = 3\nseed = 5\n" + quartz +
                         fmt::format(R"([contact]
law = "hertz-mindlin"
[specimen]
source = "cloud"
count = {}
grading = {{ min_radius = 1e-4, max_radius = 2e-4 }}
solid_fraction = 0.5
[boundary]
type = "periodic"
[damping]
{}
[timestep]
policy = "certified"
safety = 0.9
{})",
                                     grains, damping, stages),
                     "steps.toml");
}

/// What a stage has shown.
struct ControlledStage {
  std::string name;
  std::uint64_t steps = 0;
  int instants = 0;                            ///< at which the limit was worked out
  double largest = 0, sum = 0;                 ///< of dt over that limit
  double seconds = 0, controller_seconds = 0;  ///< without the working out
  std::uint64_t evaluations = 0;

  double mean() const { return sum / instants; }
  double cost() const { return controller_seconds / seconds; }
};

/// Runs the stages; every so many steps the limit is proved from above (dense up to 600 degrees of freedom).
inline std::vector<ControlledStage> controlled_run(const Scene& scene, std::uint64_t every) {
  using Clock = std::chrono::steady_clock;
  const auto since = [](Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
  };
  State state = make_state(scene, make_packing(scene));
  Controller controller(scene);
  std::vector<ControlledStage> stages(1);
  double aside = 0, spent = 0;
  std::uint64_t begun = 0, evaluated = 0;
  auto begin = Clock::now();
  RunObserver observer;
  observer.step = [&](const State& s, const RunStatus&) {
    if (s.step % every != 0) return;
    const auto start = Clock::now();
    const Network net = linearise(scene, s);
    const double limit = damped_interval(net, damping_in_force(scene, s), step_interval(net)).dt_limit_upper;
    if (std::isfinite(limit)) {
      ControlledStage& stage = stages.back();
      stage.largest = std::max(stage.largest, s.dt / limit), stage.sum += s.dt / limit, ++stage.instants;
    }
    aside += since(start);
  };
  observer.stage_end = [&](const State& s, const StageSpec& spec) {
    ControlledStage& stage = stages.back();
    stage.name = spec.name, stage.steps = s.step - begun, stage.seconds = since(begin) - aside;
    stage.controller_seconds = controller.log().seconds - spent;
    stage.evaluations = controller.log().all_evaluations() - evaluated;
    begun = s.step, spent = controller.log().seconds, evaluated = controller.log().all_evaluations();
    aside = 0, begin = Clock::now();
    stages.emplace_back();
  };
  run_stages(scene, state, controller, observer);
  stages.pop_back();
  return stages;
}

}  // namespace eg::test
