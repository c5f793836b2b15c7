#include "dynamics/preparation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "boundary/cell_control.hpp"
#include "measure/volume.hpp"
#include "state/grain_mass.hpp"

namespace eg {
namespace {

constexpr double step_down = 0.9;      // of the friction
constexpr double least = 1e-3;         // friction, below it none
constexpr double near_enough = 0.005;  // by which a packing at rest may lie below its target from the beginning [-]

void set_friction(const State& state, Engine& engine, double friction) {
  engine.set_friction(std::vector<double>(state.friction.size(), friction));
}

void follow_schedule(const StageSpec& stage, State& state, Engine& engine, bool at_rest) {
  const FrictionSchedule& schedule = *stage.friction_schedule;
  auto& progress = state.preparation;
  progress.settled = progress.settled || at_rest;
  if (progress.met || !progress.settled) return;
  const bool by_volume = !std::isnan(schedule.void_ratio);
  const double target = by_volume ? schedule.void_ratio : schedule.mean_stress;
  const double value = by_volume ? void_ratio(specimen_volume(state), solid_volume(state)) : mean_stress(state);
  const double friction = state.friction.front(), first = *stage.friction;
  const auto unreachable = [&](std::string_view found, std::string_view remedy) {
    const std::string quantity = by_volume
                                     ? fmt::format("void ratio {:g}", target)
                                     : fmt::format("mean stress {:g} {}", target, state.dimension == 3 ? "Pa" : "N/m");
    return RunError(fmt::format("stage \"{}\": {} cannot be reached: the packing at rest has {:.4g} {}; {}", stage.name,
                                quantity, value, found, remedy));
  };
  if (value <= target) {
    if (friction == first && value < target * (1 - near_enough))
      throw unreachable(fmt::format("already with friction.start = {:g}", first),
                        "begin with more friction, or aim lower");
    set_friction(state, engine, first);
    progress.met = true;
  } else if (at_rest) {
    if (friction == 0) throw unreachable("without any friction", "aim higher");
    set_friction(state, engine, friction * step_down < least ? 0.0 : friction * step_down);
  }
}

void grow(State& state, Engine& engine) {
  auto& progress = state.preparation;
  const double factor = std::exp(progress.growth * (state.stage_time - progress.grown_until));
  const bool done = progress.size * factor >= 1;
  engine.grow(done ? 1 / progress.size : factor);
  progress.size = done ? 1 : progress.size * factor;
  progress.grown_until = state.stage_time;
  if (done) progress.growth = 0;
}

/// Grains above `height` stand still, all others but the glued ones move. No height (NaN): all move.
void hold_grains(const Scene& scene, double height, State& state) {
  auto& g = state.grains;
  std::vector<bool> glued(g.size());
  for (const auto& one : state.glued) glued[one.grain] = true;
  for (std::size_t i = 0; i < g.size(); ++i) {
    if (glued[i]) continue;
    const auto [mass, inertia] = grain_mass(state.dimension, scene.materials[g.material_of(i)].density, g.radius(i));
    const bool held = g.position[i].vec()[state.dimension - 1] > height;
    if (held) g.velocity[i] = Quad{};
    if (!held && g.velocity[i].w == 0) g.velocity[i].w = 1 / mass;
    if (!g.rotates()) continue;
    if (held) g.spin[i] = Quad{};
    if (!held && g.spin[i].w == 0) g.spin[i].w = 1 / inertia;
  }
}

}  // namespace

void begin_preparation(const Scene& scene, State& state) {
  const StageSpec& stage = scene.stages[state.stage];
  auto& progress = state.preparation;
  progress.settled = progress.met = false;
  progress.growth = progress.size < 1 ? stage.radius_growth : 0;
  progress.grown_until = 0;
  const auto holds = [](const StageSpec& s) { return !std::isnan(s.held_above); };
  if (std::ranges::any_of(scene.stages, holds)) hold_grains(scene, stage.held_above, state);
}

Vec3 gravity_in_force(const Scene& scene, const State& state) {
  const auto& shake = scene.stages[state.stage].shake;
  if (!shake) return scene.gravity;
  return scene.gravity + std::cos(2 * std::numbers::pi * shake->frequency * state.stage_time) * shake->acceleration;
}

void prepare_grains(const StageSpec& stage, State& state, Engine& engine, bool at_rest) {
  if (state.preparation.growth > 0) grow(state, engine);
  if (stage.friction_schedule) follow_schedule(stage, state, engine, at_rest);
}

bool is_prepared(const StageSpec& stage, const State& state) {
  return (!stage.friction_schedule || state.preparation.met) && !(state.preparation.growth > 0);
}

}  // namespace eg
