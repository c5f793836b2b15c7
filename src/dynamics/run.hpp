#pragma once
// Takes a state through the stages of its scene.
#include <functional>

#include "dynamics/engine.hpp"

namespace eg {

/// Chooses the step. Filled in by the program with what it knows of stability.
class StepPolicy {
 public:
  virtual ~StepPolicy() = default;
  /// A run begins, or goes on with this state.
  virtual void begin(const State& /*state*/) {}
  /// Length of the next step [s], asked before the forces of every step, `schedule` being that of its lists. May keep
  /// its plan in state.policy.
  virtual double next_step(State& state, const Schedule& schedule) = 0;
};

/// What an observer is shown.
struct RunStatus {
  const StageSpec& stage;
  const Engine& engine;
  double unbalanced = 0;    ///< mean net force over mean contact force [-]
  double stress_error = 0;  ///< [-]
  double kinetic = 0;       ///< [J]
};

/// Hears what happens; every call is optional.
struct RunObserver {
  std::function<void(const State&, const RunStatus&)> step;       ///< after every step (progress; keep it cheap)
  std::function<void(const State&, const RunStatus&)> record;     ///< a row of the history is due
  std::function<void(const State&)> snapshot;                     ///< a snapshot is due
  std::function<void(const State&, const StageSpec&)> stage_end;  ///< a stage has just ended
  std::function<bool()> stop;                                     ///< true: leave as soon as possible
};

/// Runs (or goes on with) all stages. Returns false when the observer stopped it; the state can be resumed bit for bit
/// then. Throws RunError when a stage does not end within its max_steps, or a position is no longer finite.
bool run_stages(const Scene& scene, State& state, StepPolicy& policy, const RunObserver& observer, bool scalar = false);

}  // namespace eg
