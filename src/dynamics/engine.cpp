#include "dynamics/engine.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>

#include "boundary/membrane.hpp"
#include "dynamics/bonds.hpp"
#include "measure/volume.hpp"
#include "search/neighbours.hpp"
#include "state/friction.hpp"
#include "state/gather.hpp"

namespace eg {

/// Who made the engine may move grains yet: the first step has to look where they are.
static void forget(Blocks& blocks) {
  const Double4 anywhere = Double4{} + 1e100;  // [m]; its square is a number
  if (blocks.count() > 0) blocks.move(0, -anywhere, anywhere);
}

Engine::Engine(const Scene& scene, State& state, bool scalar) : scene_(scene), state_(state) {
  state_.friction = friction_in_force(scene, state_);
  loop_ = make_force_loop(scene.contact.law, !has_friction(scene), state_.grains.rotates());
  loop_->set_materials(scene.materials, state_.friction, scene.dimension);
  const bool viscous = scene.energy && scene.damping.dashpots();
  options_ = {arms_of(scene), scene.damping.normal_ratio, scene.damping.shear_ratio, TallyLevel::none, viscous, scalar};
  kick_ = {scene.damping.local, scene.damping.mass, scene.gravity, scene.dimension};
  last_dt_ = state_.dt;
  const std::size_t tail = viscous ? 1 : 0, size = loop_->history_size() + 3 * tail;
  const Contacts& listed = state_.contacts;
  if (listed.history_size == size && listed.history_vectors == loop_->history_vectors() &&
      listed.tail_vectors == tail && !state_.list.begin.empty()) {  // goes on
    refresh_workspace();
    blocks_.reset(state_);
    forget(blocks_);
    return;
  }
  state_.contacts = {}, state_.wall_contacts = {}, state_.list = {};  // what another law left means nothing here
  state_.contacts.tail_vectors = tail, state_.contacts.history_size = size;
  state_.contacts.history_vectors = loop_->history_vectors(), state_.contacts.bond_value = loop_->bond_value();
  const auto [skin, contact_skin] = default_skins(state_);
  rebuild_neighbours(state_, skin, contact_skin);
  lay_membrane(scene_, state_);
  refresh_workspace();
  blocks_.reset(state_);
  forget(blocks_);
  forces(0, TallyLevel::works);
}

void Engine::refresh_workspace() {
  prepare(work_, state_, *loop_);
  glued_rows_.clear();
  if (state_.glued.empty()) return;
  glued_to_.assign(state_.grains.size(), no_index);
  for (const auto& g : state_.glued) glued_to_[g.grain] = g.body, glued_rows_.push_back({g.grain, g.body});
  for (std::size_t e = 0; e < work_.schedule.gather_row.size(); ++e)
    if (const Index b = glued_to_[work_.schedule.gather_grain[e]]; b != no_index)
      glued_rows_.push_back({work_.schedule.gather_row[e], b});
}

void Engine::set_friction(const std::vector<double>& friction) {
  state_.friction = friction;
  loop_->set_materials(scene_.materials, friction, scene_.dimension);
}

void Engine::grow(double factor) {
  auto& g = state_.grains;
  const double volume = std::pow(factor, state_.dimension);
  double largest = 0;
  for (auto& p : g.position) largest = std::max(largest, p.w), p.w *= factor;
  for (auto& v : g.velocity) v.w /= volume;
  for (auto& s : g.spin) s.w /= volume * factor * factor;
  state_.list.grown += 2 * largest * (factor - 1);
}

void Engine::bond(const BondSpec& spec) {
  const double contact_skin = state_.list.contact_skin, skin = state_.list.skin;
  if (spec.gap > contact_skin) {
    rebuild_neighbours(state_, std::max(skin, 1.5 * spec.gap), spec.gap);
    state_.list.skin = skin, state_.list.contact_skin = contact_skin;
    refresh_workspace();
    blocks_.reset(state_);
    forces(0, TallyLevel::works);
  }
  for (const std::size_t c : pairs_to_bond(state_, spec, scene_.seed)) {
    loop_->bond(state_.contacts, c, overlap_of(state_, c));
    ++state_.bonds.made;
  }
}

void Engine::forces(double dt, TallyLevel tally) { forces(dt, tally, {}); }

void Engine::forces(double dt, TallyLevel tally, const AfterChunk& after) {
  options_.tally = level_ = tally;
  const Mat3 virial_before = state_.virial;
  const double power_before = body_power(state_);
  const double applied = scene_.energy ? 0.5 * applied_work(state_, dt) : 0;  // with the velocities before any kick
  for (auto& b : state_.bodies) b.force = Vec3{}, b.spread = b.magnitude = b.stiffness = 0;
  work_.clear();
  Tally now;
  if (!state_.walls.empty()) now = loop_->walls(state_, work_, dt, options_);
  add_applied();
  const bool weighs = !state_.glued.empty();  // what glued grains feel is read before the kick uses it up
  const AfterChunk later;
  const Tally grains = loop_->contacts(state_, work_, dt, options_, weighs ? later : after);
  if (weighs) {
    weigh_glued();
    if (after)
      for (std::size_t k = 0; k < work_.schedule.chunks(); ++k) after(k);
  }
  state_.bonds.pulled += static_cast<std::uint64_t>(grains.pulled),
      state_.bonds.cut += static_cast<std::uint64_t>(grains.cut);
  if (tally == TallyLevel::none) return;
  now += grains;
  const Mat3 virial = now.virial;
  if (tally == TallyLevel::works) tally_ = now;
  state_.virial = virial;
  state_.stiffness_sum = now.stiffness_sum;
  auto& e = state_.ledger;
  e.shear_work += now.shear_work, e.friction += now.friction, e.viscous_damping += now.viscous;
  for (std::size_t k = 0; k < 9; ++k)
    e.boundary -= 0.5 * (virial_before.a[k] + virial.a[k]) * state_.cell.rate.a[k] * dt;
  e.boundary += 0.5 * (power_before + body_power(state_)) * dt + applied;
}

void Engine::change_membrane() {
  if (state_.membrane.stress == membrane_stress(scene_, state_)) return;
  const double before = applied_work(state_, state_.dt);
  lay_membrane(scene_, state_);
  if (scene_.energy) state_.ledger.boundary += 0.5 * (before - applied_work(state_, state_.dt));  // as drift() counts
}

void Engine::add_applied() {
  for (const auto& f : state_.applied) {
    Quad& row = work_.rows[work_.stride * f.grain];
    row.set(row.vec() + f.force);
  }
}

/// What grains receive from driven bodies [W]; the energy of bodies that go where forces take them is the system's own.
double Engine::body_power(const State& state) {
  double power = 0;
  for (const auto& b : state.bodies) {
    for (int k = 0; k < 3; ++k)
      if (!b.free[static_cast<std::size_t>(k)]) power -= b.force[k] * b.velocity[k];
    power -= b.spread * b.opening;
  }
  return power;
}

/// What grains do to a glued one, they do to its body.
void Engine::weigh_glued() {
  for (const auto& [row, body] : glued_rows_) state_.bodies[body].force += work_.rows[row * work_.stride].vec();
  if (state_.step % 64 == 0 || weigh_anew_) {
    for (auto& b : state_.bodies) b.glued_stiffness = 0;
    visit_contacts(scene_, state_, [&](const ContactPoint& p) {
      if (p.j == no_index || glued_to_[p.i] == glued_to_[p.j]) return;
      for (const Index g : {p.i, p.j})
        if (glued_to_[g] != no_index)
          state_.bodies[glued_to_[g]].glued_stiffness += std::max(p.normal.stiffness, p.normal.tangential);
    });
    weigh_anew_ = false;
  }
  for (auto& b : state_.bodies) b.stiffness += b.glued_stiffness;
}

void Engine::drift() {
  const double dt = state_.dt;
  if (scene_.energy) state_.ledger.boundary += 0.5 * applied_work(state_, dt);  // the other half: forces()
  for (const auto& g : state_.glued) state_.grains.velocity[g.grain].set(state_.bodies[g.body].velocity);
  eg::drift(state_, dt, blocks_);
  // Bounds, the cheapest first; rounding aside, they tell.
  const auto told = [&](const Travel& t) { return !outdated(state_, {1.001 * t.most, 1.001 * t.approach}); };
  if (!told(blocks_.coarse()) && !told(blocks_.travel())) {
    const double begin = omp_get_wtime();
    blocks_.measure(state_);
    if (update_lists(state_, blocks_.travel(), list_scratch_)) {
      lay_membrane(scene_, state_);
      refresh_workspace();
      blocks_.reset(state_);
    }
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
  if (!state_.bodies.empty()) sums_ += kick_bodies(state_, 0.5 * (last_dt_ + next_dt), kick_);
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
  return s *= 1 / specimen_volume(state);
}

}  // namespace eg
