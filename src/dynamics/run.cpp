#include "dynamics/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.hpp"
#include "boundary/body_control.hpp"
#include "boundary/cell_control.hpp"
#include "dynamics/preparation.hpp"
#include "state/damping.hpp"
#include "state/friction.hpp"

namespace eg {
namespace {

bool given(double x) { return !std::isnan(x); }

void begin_stage(const Scene& scene, State& state) {
  const StageSpec& stage = scene.stages[state.stage];
  state.friction = pair_friction(scene, stage);
  state.stage_step = 0;
  state.stage_time = 0;
  state.cell.strain = state.cell.strain_low = Mat3{};
  state.servo = {};
  state.cycle = {};
  state.policy = {};
  begin_body_stage(scene, state);
  begin_preparation(scene, state);
}

void apply_stage(const Scene& scene, const State& state, Engine& engine) {
  engine.set_friction(std::vector<double>(state.friction));
  engine.set_local_damping(damping_in_force(scene, state).local);
  engine.set_gravity(gravity_in_force(scene, state));
}

void glue(const Scene& scene, State& state, Engine& engine) {
  const auto& bodies = scene.stages[state.stage].glue;
  if (bodies.empty()) return;
  glue_grains(state, bodies);
  engine.renew();
}

void make_bonds(const Scene& scene, const State& state, Engine& engine) {
  if (const auto& bond = scene.stages[state.stage].bond) engine.bond(*bond);
}

/// A cycle ends when its quantity is back at the mean after both limits.
bool cycles_done(const State& state, const StageSpec& s) {
  const double turns = static_cast<double>(state.cycle.turns);
  return turns >= 2 * s.until_cycles && cycle_value(state, *s.cycle) >= s.cycle->mean;
}

bool strained_out(const State& state, const StageSpec& s) {
  if (!s.cycle) return false;
  const auto strain = stage_strain(state);
  return std::ranges::any_of(strain, [&](double e) { return std::abs(e) > s.cycle->largest_strain; });
}

/// Whether the stage's conditions of rest hold; true when it names none.
bool at_rest(const StageSpec& s, const RunStatus& status) {
  if (given(s.until_stress_error) && !(status.stress_error < s.until_stress_error)) return false;
  return !given(s.until_unbalanced) || status.unbalanced < s.until_unbalanced;
}

bool finished(const State& state, const StageSpec& s, const RunStatus& status, bool checked) {
  if (strained_out(state, s)) return true;
  if (!is_prepared(s, state)) return false;
  if (!checked && (given(s.until_stress_error) || given(s.until_unbalanced))) return false;
  if (given(s.until_steps) && static_cast<double>(state.stage_step) < s.until_steps) return false;
  if (given(s.until_time) && state.stage_time < s.until_time) return false;
  if (given(s.until_axial_strain) && axial_strain(state) < s.until_axial_strain) return false;
  if (given(s.until_shear_strain) && shear_strain(state) < s.until_shear_strain) return false;
  if (given(s.until_displacement) && largest_displacement(state) < s.until_displacement) return false;
  if (given(s.until_cycles) && !cycles_done(state, s)) return false;
  return at_rest(s, status);
}

bool every(const State& state, double n) {
  return given(n) && std::fmod(static_cast<double>(state.stage_step), n) == 0;
}
double record_interval(const StageSpec& s) {
  const bool otherwise = given(s.record_every_strain) || given(s.record_every_displacement);
  return given(s.record_every_steps) || otherwise ? s.record_every_steps : 1000;
}

/// What a step must add up: all that checks and rows need at every tenth step and where a row falls by steps, the
/// stress for a servo or for rows by strain, else nothing.
TallyLevel tally_level(const State& state, const StageSpec& s) {
  if (state.stage_step % 10 == 0 || every(state, record_interval(s)) || every(state, s.until_steps))
    return TallyLevel::works;
  return needs_stress(s) || given(s.record_every_strain) || given(s.record_every_displacement) ? TallyLevel::stress
                                                                                               : TallyLevel::none;
}

/// The strain that rows by strain go by: axial, or the largest shear where that is more.
double row_strain(const State& state) { return std::max(axial_strain(state), shear_strain(state)); }

/// How far the stage has come in what rows may go by.
struct Progress {
  double strain, displacement;
};
Progress progress_of(const State& state) { return {row_strain(state), largest_displacement(state)}; }

bool passes(double before, double now, double interval) {
  return given(interval) && std::floor(now / interval) != std::floor(before / interval);
}

/// Whether a row is due: by steps, or by strain or displacement passing a multiple of the interval.
bool due(const State& state, const StageSpec& s, const Progress& before) {
  const Progress now = progress_of(state);
  return passes(before.strain, now.strain, s.record_every_strain) ||
         passes(before.displacement, now.displacement, s.record_every_displacement) || every(state, record_interval(s));
}

bool snapshot_due(const State& state, const StageSpec& s, const Progress& before) {
  return every(state, s.snapshot_every_steps) ||
         passes(before.displacement, largest_displacement(state), s.snapshot_every_displacement);
}

/// The policy's step, but not beyond what bodies that move freely allow. A fixed step stays as it was ordered.
double next_step(const Scene& scene, State& state, const Engine& engine, StepPolicy& policy) {
  const double dt = policy.next_step(state, engine.workspace().schedule);
  return scene.timestep.policy == "fixed" ? dt : std::min(dt, body_step_limit(state));
}

}  // namespace

bool run_stages(const Scene& scene, State& state, StepPolicy& policy, const RunObserver& observer, bool scalar) {
  if (state.stage >= scene.stages.size()) return true;
  const bool begins = state.step == 0 && state.stage == 0;
  if (begins) begin_stage(scene, state);
  Engine engine(scene, state, scalar);
  if (begins) glue(scene, state, engine);
  engine.change_membrane();
  apply_stage(scene, state, engine);
  if (begins) make_bonds(scene, state, engine);
  policy.begin(state);
  std::optional<CellControl> control(std::in_place, scene.stages[state.stage], state, scene.materials.front().density);
  std::optional<BodyControl> bodies(std::in_place, scene, state);
  if (state.step == 0) {  // half a kick, velocities move on to dt/2; the step is chosen knowing how the cell sets out
    control->set_rate(state, policy.next_step(state, engine.workspace().schedule));
    state.policy = {};
    engine.kick(next_step(scene, state, engine, policy));
    bodies->drive(state, state.dt);
  }

  while (state.stage < scene.stages.size()) {
    const StageSpec& stage = scene.stages[state.stage];
    const Progress before = progress_of(state);
    ++state.stage_step;
    const TallyLevel level = tally_level(state, stage);
    const double taken = state.dt;
    engine.drift();
    state.stage_time += taken;
    engine.set_gravity(gravity_in_force(scene, state));
    engine.respond(next_step(scene, state, engine, policy), level);
    control->set_rate(state, taken);
    bodies->drive(state, state.dt);
    const bool checked = level == TallyLevel::works;
    if (checked) state.unbalanced = engine.unbalanced_ratio();
    if (checked || scene.energy) state.kinetic = engine.kick_sums().kinetic;  // rows by strain fall between checks

    const RunStatus status{stage, engine, state.unbalanced,
                           std::max(stress_error(state, stage), servo_error(scene, state)), state.kinetic};
    if (!std::isfinite(status.kinetic))
      throw RunError(fmt::format(
          "step {}: the motion is no longer finite; the step {:.3g} s was unstable: use policy = \"certified\"",
          state.step, taken));
    if (state.stage_step % 10 == 0) prepare_grains(stage, state, engine, at_rest(stage, status));
    const bool ends = finished(state, stage, status, checked);
    if (observer.step) observer.step(state, status);
    if (observer.record && (ends || due(state, stage, before))) observer.record(state, status);
    if (ends) {
      if (observer.stage_end) observer.stage_end(state, stage);
      if (++state.stage < scene.stages.size()) {
        begin_stage(scene, state), engine.change_membrane(), apply_stage(scene, state, engine),
            make_bonds(scene, state, engine);
        control.emplace(scene.stages[state.stage], state, scene.materials.front().density);
        control->set_rate(state, taken);  // the cell is not to drift on at the rates of the stage before
        glue(scene, state, engine);
        bodies.emplace(scene, state);
        bodies->drive(state, state.dt);
      }
    } else if (static_cast<double>(state.stage_step) >= stage.max_steps) {
      const TargetMiss missed = worst_target(state, stage);
      throw RunError(fmt::format(
          "stage \"{}\" has not met its `until` within max_steps = {:.0f}: {}{}unbalanced force {:.2e}; is the target "
          "possible, max_strain_rate high enough, damping on?",
          stage.name, stage.max_steps, missed.text, missed.text.empty() ? "" : "; ", status.unbalanced));
    }
    if (observer.snapshot && !ends && snapshot_due(state, stage, before)) observer.snapshot(state);
    if (observer.stop && observer.stop()) return state.stage >= scene.stages.size();
  }
  return true;
}

}  // namespace eg
