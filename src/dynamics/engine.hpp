#pragma once
// One explicit step: drift, lists, forces and kick. Knows nothing of stages, files or how the step was chosen.
#include "dynamics/force_loop.hpp"
#include "dynamics/integrate.hpp"
#include "search/neighbours.hpp"

namespace eg {

class Engine {
 public:
  /// Works on `state` in place. A state without lists gets them, and its first forces (with no motion behind them).
  /// `scalar`: the reference force loop. Throws RunError when the cell is too narrow for its grains.
  Engine(const Scene& scene, State& state, bool scalar = false);

  void set_friction(const std::vector<double>& friction);  ///< as State::friction
  void set_local_damping(double alpha) { kick_.local = alpha; }

  void set_gravity(const Vec3& g) { kick_.gravity = g; }  ///< [m/s²]

  /// Makes every radius `factor` ≥ 1 times as large, masses and moments of inertia along with it (density stays).
  void grow(double factor);

  /// Makes bonds between grains that have none, at their present distance: no force changes.
  void bond(const BondSpec& spec);

  /// Positions over state.dt, and the lists.
  void drift();
  /// Forces at the new time, and velocities on to the next half step; the next drift will take next_dt [s]. With an
  /// energy ledger everything is tallied at every step.
  void respond(double next_dt, TallyLevel tally);
  /// Both, with one step length.
  void step(double dt, TallyLevel tally = TallyLevel::works) {
    drift();
    respond(dt, tally);
  }
  /// A stage has begun: the membrane is laid anew if its pressure is another.
  void change_membrane();
  /// What may move has changed (grains were glued): scratch that depends on it is made anew.
  void renew() { refresh_workspace(), weigh_anew_ = true; }
  /// Velocities alone, by forces() at hand: the half kick at the start.
  void kick(double next_dt);

  const Tally& tally() const { return tally_; }  ///< of the last move with tally
  const KickSums& kick_sums() const { return sums_; }
  const ForceWorkspace& workspace() const { return work_; }
  double upkeep() const { return upkeep_; }  ///< time spent on lists so far [s]
  /// Mean net force of grains over mean contact force in the last step with tally [-]; 1 without contacts.
  double unbalanced_ratio() const;
  /// Forces at the present positions after a motion of length dt (no drift, no list check): for tests and
  /// linearisation.
  void forces(double dt, TallyLevel tally);

 private:
  void refresh_workspace();
  void forces(double dt, TallyLevel tally, const AfterChunk& after);
  void end_kick(double next_dt);
  void weigh_glued();
  void add_applied();
  static double body_power(const State& state);

  const Scene& scene_;
  State& state_;
  std::unique_ptr<ForceLoop> loop_;
  ForceWorkspace work_;
  ForceOptions options_;
  KickOptions kick_;
  Tally tally_;
  KickSums sums_;
  TallyLevel level_ = TallyLevel::none;
  double last_dt_ = 0;
  double upkeep_ = 0;
  std::vector<Index> glued_to_;  ///< body of every grain, or none; empty when nothing is glued
  bool weigh_anew_ = false;  ///< stiffness against glued grains is worked out now and then, and when grains were glued
  std::vector<std::pair<std::size_t, Index>> glued_rows_;  ///< rows of the workspace that add up to what a body feels
  ListScratch list_scratch_;
  Blocks blocks_;  ///< how far grains have moved since contacts were refreshed, at most
};

/// Stress from the last step's contacts: virial over volume, compression positive [Pa] (2D: N/m).
Mat3 contact_stress(const State& state);

}  // namespace eg
