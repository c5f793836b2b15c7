#pragma once
// Moves the bodies of the apparatus: at given velocities, or by a servo towards a force or stress.
#include <vector>

#include "state/scene.hpp"
#include "state/state.hpp"

namespace eg {

/// A servo moves its body outward at v = α (F − F_target)/(K Δt), α = 0.5, K = Σ max(kn, kt) over the body's contacts,
/// F the force of the grains on it. docs/walls.md shows why the certified step stays safe beside it.
class BodyControl {
 public:
  /// For the stage that the state is in. Throws InputError when the loaded area of a servo cannot be told from the
  /// walls.
  BodyControl(const Scene& scene, const State& state);

  /// Velocities for the step to come, of length dt [s]. Bodies that are free are left to the integrator.
  void drive(State& state, double dt) const;

 private:
  const Scene& scene_;
  std::vector<BodyDrive> drives_;  ///< one a body
};

/// A stage begins: ways are counted from here, bodies are set free or held, walls that it removes are taken away.
void begin_body_stage(const Scene& scene, State& state);

/// Grains that touch one of the bodies in `glue` become part of it.
void glue_grains(State& state, const std::vector<std::size_t>& glue);

/// Largest step that free bodies allow, √(m/K) [s]; infinite without one.
double body_step_limit(const State& state);

/// What grains press on a body with, out of the specimen [N] (along its servo's direction; without servo that of its
/// first plane or cylinder), and on which area [m²] (2D: N/m and m); NaN where walls do not tell. An end of a specimen
/// in a membrane is seldom as wide as its mean section: a part of the force, bias, does no more than balance the
/// membrane's loads along the axis, and what is left over the mean section is the mean stress of the grains.
struct BodyLoad {
  double force = not_given, area = not_given, bias = 0;
  double stress() const { return (force - bias) / area; }
};
BodyLoad body_load(const Scene& scene, const State& state, const BodyDrive& drive);
/// σ3 + (load beyond it)/(section that the outermost grains span) [Pa] (2D: N/m), as a laboratory has it that measures
/// the specimen from outside. NaN without a membrane and for bodies without a plane across x, y or z.
double outer_stress(const Scene& scene, const State& state, std::size_t body);
/// The drive of a body in the stage under way.
BodyDrive drive_of(const Scene& scene, const State& state, std::size_t body);

/// Largest |F − F_target|/F_target over the servos of the stage under way; 0 without one.
double servo_error(const Scene& scene, const State& state);

/// Largest way of a body, or growth of a radius, since the stage began [m].
double largest_displacement(const State& state);

}  // namespace eg
