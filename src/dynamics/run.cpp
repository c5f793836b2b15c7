#include "dynamics/run.hpp"

#include <fmt/format.h>

#include <cmath>

#include "base/error.hpp"
#include "boundary/cell_control.hpp"

namespace eg {
namespace {

bool given(double x) { return !std::isnan(x); }

void begin_stage(const Scene& scene, State& state) {
  const StageSpec& stage = scene.stages[state.stage];
  state.friction.clear();
  for (const auto& m : scene.materials) state.friction.push_back(stage.friction.value_or(m.friction));
  state.stage_step = 0;
  state.stage_time = 0;
  state.stage_cell = state.cell.h;
  state.servo = {};
  state.policy = {};
}

void apply_stage(const Scene& scene, const State& state, Engine& engine) {
  engine.set_friction(std::vector<double>(state.friction));
  engine.set_local_damping(scene.stages[state.stage].local_damping.value_or(scene.damping.local));
}

bool finished(const State& state, const StageSpec& s, const RunStatus& status) {
  if (given(s.until_steps) && static_cast<double>(state.stage_step) < s.until_steps) return false;
  if (given(s.until_time) && state.stage_time < s.until_time) return false;
  if (given(s.until_axial_strain) && std::abs(stage_strain(state)[state.dimension == 3 ? 2 : 1]) < s.until_axial_strain)
    return false;
  if (given(s.until_stress_error) && !(status.stress_error < s.until_stress_error)) return false;
  if (given(s.until_unbalanced) && !(status.unbalanced < s.until_unbalanced)) return false;
  return true;
}

/// Whether a row is due: by steps, or by axial strain passing a multiple of the interval.
bool due(const State& state, const StageSpec& s, double strain_before) {
  const auto every = [&](double n) { return given(n) && std::fmod(static_cast<double>(state.stage_step), n) == 0; };
  if (given(s.record_every_strain)) {
    const double now = std::abs(stage_strain(state)[state.dimension == 3 ? 2 : 1]);
    if (std::floor(now / s.record_every_strain) != std::floor(strain_before / s.record_every_strain)) return true;
    return every(s.record_every_steps);
  }
  return every(given(s.record_every_steps) ? s.record_every_steps : 1000);
}

}  // namespace

bool run_stages(const Scene& scene, State& state, StepPolicy& policy, const RunObserver& observer, bool scalar) {
  if (state.stage >= scene.stages.size()) return true;
  if (state.step == 0 && state.stage == 0) begin_stage(scene, state);
  Engine engine(scene, state, scalar);
  apply_stage(scene, state, engine);
  if (state.step == 0) engine.kick(policy.next_step(state));  // half a kick: velocities move on to dt/2

  while (state.stage < scene.stages.size()) {
    const StageSpec& stage = scene.stages[state.stage];
    const double strain_before = std::abs(stage_strain(state)[state.dimension == 3 ? 2 : 1]);
    engine.move(true);
    ++state.stage_step;
    state.stage_time += state.dt;
    const double taken = state.dt;
    control_cell(state, stage, taken);
    engine.kick(policy.next_step(state));

    const RunStatus status{stage, engine, engine.unbalanced_ratio(), stress_error(state, stage),
                           engine.kick_sums().kinetic};
    if (!std::isfinite(status.kinetic))
      throw RunError(fmt::format(
          "step {}: the motion is no longer finite; the step {:.3g} s was unstable: use policy = \"certified\"",
          state.step, taken));
    const bool ends = finished(state, stage, status);
    if (observer.step) observer.step(state, status);
    if (observer.record && (ends || due(state, stage, strain_before))) observer.record(state, status);
    if (ends) {
      if (observer.stage_end) observer.stage_end(state, stage);
      if (++state.stage < scene.stages.size()) begin_stage(scene, state), apply_stage(scene, state, engine);
    } else if (static_cast<double>(state.stage_step) >= stage.max_steps) {
      throw RunError(fmt::format(
          "stage \"{}\" has not met its `until` within max_steps = {:.0f}: stress error {:.2e}, unbalanced force "
          "{:.2e}; is the target possible, max_strain_rate high enough, damping on?",
          stage.name, stage.max_steps, status.stress_error, status.unbalanced));
    }
    if (observer.snapshot && !ends && given(stage.snapshot_every_steps) &&
        std::fmod(static_cast<double>(state.stage_step), stage.snapshot_every_steps) == 0)
      observer.snapshot(state);
    if (observer.stop && observer.stop()) return state.stage >= scene.stages.size();
  }
  return true;
}

}  // namespace eg
