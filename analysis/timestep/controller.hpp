#pragma once
// Chooses the step during a run, as [timestep] of the scene says.
#include <array>
#include <functional>
#include <string>

#include "dynamics/run.hpp"
#include "timestep/standing_bound.hpp"

namespace eg {

/// Why the step was chosen anew.
enum class StepCause : int {
  start,    ///< of the run
  stage,    ///< another stage began
  growth,   ///< contacts outgrew what the bound allows them
  renewal,  ///< the bound was old,
  rebuild,  ///< the grains were sorted anew
};
inline constexpr std::size_t step_causes = 5;
std::string step_cause_name(StepCause cause);

/// What the controller has done, for the report of the run.
struct ControllerLog {
  std::array<std::uint64_t, step_causes> evaluations{};  ///< by cause
  std::uint64_t checks = 0;                              ///< that the bound still stands
  std::uint64_t mended = 0;   ///< grains that checks found beyond the bound by the weights at hand
  double seconds = 0;         ///< spent on all of it
  double worst_ratio = 0;     ///< largest step chosen over the certified limit in force [-]
  double worst_true = 0;      ///< largest step taken over the limit's upper end found at its last moment [-]
  std::uint64_t outruns = 0;  ///< times that the certified limit was found above that end: contacts outran a forecast

  std::uint64_t all_evaluations() const;
};

/// policy "certified": dt = safety × certified limit; "fixed": the given dt; "estimate:NAME": safety × that rule of
/// thumb. All of them are held against the certified limit.
///
/// The certificate is a StandingBound: a bound of λmax with some room, checked at intervals (new pairs whenever the
/// list of contacts changes) at the overlaps and directions that pairs can reach until the next check with half as much
/// again as their present speed. When a check fails, or the bound is old, it is renewed. The step never exceeds that of
/// the lightest grain with twelve contacts at an overlap of 1e-6 radii, which governs while little or nothing touches.
class Controller final : public StepPolicy {
 public:
  explicit Controller(const Scene& scene) : scene_(scene), bounds_(scene) {}
  void begin(const State& state) override { bounds_.remember(state); }
  double next_step(State& state, const Schedule& schedule) override;
  const ControllerLog& log() const { return log_; }
  /// Called after every evaluation, with state.policy as it then is.
  std::function<void(const State&)> on_change;

 private:
  void evaluate(State& state, const Schedule& schedule, StepCause cause);
  void choose(State& state);
  bool still_stands(State& state, const Schedule& schedule);
  double free_limit(const State& state) const;

  const Scene& scene_;
  StandingBounds bounds_;
  ControllerLog log_;
};

}  // namespace eg
