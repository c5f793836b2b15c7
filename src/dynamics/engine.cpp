#include "dynamics/engine.hpp"

#include <omp.h>

#include <algorithm>

#include "search/neighbours.hpp"
#include "state/gather.hpp"

namespace eg {

Engine::Engine(const Scene& scene, State& state, bool scalar) : scene_(scene), state_(state) {
  if (state_.friction.empty())
    for (const auto& m : scene.materials) state_.friction.push_back(m.friction);
  bool frictionless = true;
  for (const auto& m : scene.materials) frictionless = frictionless && m.friction == 0;
  for (const auto& s : scene.stages) frictionless = frictionless && s.friction.value_or(0) == 0;
  loop_ = make_force_loop(scene.contact.law, frictionless, state_.grains.rotates());
  loop_->set_materials(scene.materials, state_.friction, scene.dimension);
  const bool viscous = scene.energy && scene.damping.dashpots();
  options_ = {arms_of(scene), scene.damping.normal_ratio, scene.damping.shear_ratio, TallyLevel::none, viscous, scalar};
  kick_ = {scene.damping.local, scene.damping.mass, scene.gravity, scene.dimension};
  last_dt_ = state_.dt;
  if (!state_.list.begin.empty()) {  // resumed
    refresh_workspace();
    return;
  }
  state_.contacts.tail_vectors = viscous ? 1 : 0;
  state_.contacts.history_size = loop_->history_size() + 3 * state_.contacts.tail_vectors;
  state_.contacts.history_vectors = loop_->history_vectors();
  const auto [skin, contact_skin] = default_skins(state_);
  rebuild_neighbours(state_, skin, contact_skin);
  refresh_workspace();
  forces(0, TallyLevel::works);
}

void Engine::refresh_workspace() { prepare(work_, state_, *loop_); }

void Engine::set_friction(const std::vector<double>& friction) {
  state_.friction = friction;
  loop_->set_materials(scene_.materials, friction, scene_.dimension);
}

void Engine::forces(double dt, TallyLevel tally) { forces(dt, tally, {}); }

void Engine::forces(double dt, TallyLevel tally, const AfterChunk& after) {
  options_.tally = level_ = tally;
  const Mat3 virial_before = state_.virial;
  double wall_power = 0;
  for (const auto& w : state_.walls) wall_power -= 0.5 * dot(w.force, w.velocity);
  work_.clear();
  Tally now;
  if (!state_.walls.empty()) now = loop_->walls(state_, work_, dt, options_);
  const Tally grains = loop_->contacts(state_, work_, dt, options_, after);
  if (tally == TallyLevel::none) return;
  const Mat3 virial = grains.virial;
  now += grains;
  if (tally == TallyLevel::works) tally_ = now;
  state_.virial = virial;
  state_.stiffness_sum = now.stiffness_sum;
  auto& e = state_.ledger;
  e.shear_work += now.shear_work, e.friction += now.friction, e.viscous_damping += now.viscous;
  for (std::size_t k = 0; k < 9; ++k)
    e.boundary -= 0.5 * (virial_before.a[k] + virial.a[k]) * state_.cell.rate.a[k] * dt;
  for (const auto& w : state_.walls) wall_power -= 0.5 * dot(w.force, w.velocity);
  e.boundary += wall_power * dt;
}

void Engine::drift() {
  const double dt = state_.dt;
  travelled_ += (travelled_ * norm(state_.cell.rate) + eg::drift(state_, dt)) * dt;
  if (used_skin(state_, travelled_) > 0.999 * state_.list.contact_skin) {  // rounding aside, the bound tells
    const double begin = omp_get_wtime();
    travelled_ = displacement(state_);
    if (update_lists(state_, travelled_)) refresh_workspace(), travelled_ = 0;
    upkeep_ += omp_get_wtime() - begin;
  }
  last_dt_ = dt;
  state_.time += dt;
  ++state_.step;
}

void Engine::respond(double next_dt, TallyLevel tally) {
  if (scene_.energy) tally = TallyLevel::works;
  const bool works = tally == TallyLevel::works;
  const double span = 0.5 * (last_dt_ + next_dt);
  forces(last_dt_, tally, [&](std::size_t k) { kick_chunk(state_, work_, k, span, kick_, works); });
  end_kick(next_dt);
}

void Engine::kick(double next_dt) {
  const double span = 0.5 * (last_dt_ + next_dt);
  for (std::size_t k = 0; k < work_.schedule.chunks(); ++k)
    kick_chunk(state_, work_, k, span, kick_, level_ == TallyLevel::works);
  end_kick(next_dt);
}

void Engine::end_kick(double next_dt) {
  work_.clean = true;
  sums_ = {};
  for (const auto& s : work_.kick_sums) sums_ += s;
  auto& e = state_.ledger;
  e.local_damping += sums_.local_damping, e.mass_damping += sums_.mass_damping;
  e.body += sums_.body, e.boundary += sums_.affine;
  state_.dt = next_dt;
}

double Engine::unbalanced_ratio() const {
  if (!(tally_.force_sum > 0)) return 1;
  const double mean_contact = tally_.force_sum / tally_.touching;
  return sums_.unbalanced / static_cast<double>(state_.grains.size()) / mean_contact;
}

Mat3 contact_stress(const State& state) {
  Mat3 s = state.virial;
  return s *= 1 / state.cell.volume();
}

}  // namespace eg
