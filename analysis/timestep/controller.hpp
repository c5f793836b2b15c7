#pragma once
// Chooses the step during a run, as [timestep] of the scene says.
#include <string>

#include "dynamics/run.hpp"
#include "state/scene.hpp"
#include "timestep/splitting.hpp"

namespace eg {

/// What the controller has seen, for the report of the run.
struct ControllerLog {
  std::uint64_t evaluations = 0;
  double seconds = 0;      ///< spent on evaluations
  double worst_ratio = 0;  ///< largest step taken over the certified limit in force [-]
};

/// policy "certified": dt = safety × certified limit; "fixed": the given dt; "estimate:NAME": safety × that rule of
/// thumb. All of them are held against the certified limit.
///
/// The certificate is the contact-splitting bound of the springs as they can be at the end of the horizon: every listed
/// pair at the overlap it reaches with half as much again as its present closing speed. λmax is monotone in every
/// stiffness and in the set of contacts, so the bound holds for all steps in between unless a contact outruns that
/// forecast; safety < 1 covers this. The step never exceeds that of the lightest grain with twelve contacts at an
/// overlap of 1e-6 radii, which governs while little or nothing touches.
class Controller final : public StepPolicy {
 public:
  explicit Controller(const Scene& scene) : scene_(scene) {}
  double next_step(State& state) override;
  const ControllerLog& log() const { return log_; }

 private:
  void evaluate(State& state);
  double free_limit(const State& state) const;

  const Scene& scene_;
  ControllerLog log_;
};

}  // namespace eg
