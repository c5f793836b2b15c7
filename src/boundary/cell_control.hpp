#pragma once
// Drives the periodic cell through a stage: strain components at a rate, stresses and linear conditions of both.
#include <string>

#include "state/drive.hpp"
#include "state/state.hpp"

namespace eg {

/// One stage's control of the cell. Compression positive for x, y, z; shear rates are dv_x/dy and so on.
///
/// Rates and rate conditions hold exactly. An equation on stress is answered by ε̇ with (stiffness · ε̇)/M = e/(Mτ) +
/// ∫ e dt/(4Mτ²), e = target − value: without offset for a steady target, critically damped for a packing of bulk
/// modulus M and the stiffness of class Drive, which also anticipates what the driven rates do to the held stresses.
/// M = Σ kn d²/(9V) (2D: 4V) is the affine bulk modulus of the contacts at hand (Walton 1987), τ four steps: stress
/// answers an affine strain at once. The answer is scaled so that none of its components exceeds max_strain_rate; the
/// integral rests meanwhile.
class CellControl {
 public:
  /// `density` of the grains [kg/m³] and the state's d50 make strain rates of inertial numbers.
  /// Throws InputError when the stage's conditions have no unique solution.
  CellControl(const StageSpec&, const State&, double density);

  /// Sets cell.rate for the next step from the stress of the last one, and the integral part in state.servo. Turns
  /// around, in state.cycle, at a limit of the stage's cycle.
  void set_rate(State&, double dt) const;

 private:
  Components known_rates(const State&) const;

  const StageSpec* stage_;
  Drive drive_;
  double inertia_scale_;  ///< d50 √ρ: I = ε̇ d50 √ρ / √p
};

/// How far a stress target is missed, worst of all targets of a stage.
struct TargetMiss {
  double relative = 0;  ///< |value − target| over |target|, over the mean stress where the target is 0 [-]
  std::string text;     ///< "stress x = 83.2e3, target 100e3"; empty without targets
};
TargetMiss worst_target(const State&, const StageSpec&);
double stress_error(const State&, const StageSpec&);  ///< worst_target().relative, without its text

/// Whether a stage needs the stress at every step.
bool needs_stress(const StageSpec&);

/// Stress components in the order x y z yz xz xy [Pa]: compression positive; shear positive when it drives a positive
/// rate.
Components stress_components(const State&);

/// Strain of the cell since the stage began, ∫ L dt: logarithmic, compression positive for x y z, then engineering
/// shear yz xz xy [-].
Components stage_strain(const State&);
/// |strain| of the vertical axis, z (2D: y).
double axial_strain(const State&);
/// Largest |γ| of stage_strain().
double shear_strain(const State&);

/// Value of a cycle's quantity now [-] or [Pa].
double cycle_value(const State&, const CycleSpec&);

/// (σx + σy + σz)/3, 2D: (σx + σy)/2 [Pa].
double mean_stress(const State&);

}  // namespace eg
