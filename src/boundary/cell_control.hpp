#pragma once
// Drives the periodic cell: each strain component by rate or by stress, or the mean stress through several of them.
#include "state/scene.hpp"
#include "state/state.hpp"

namespace eg {

/// Sets cell.rate for the next step from the stress of the last one, and the integral part in state.servo.
///
/// Servoed components follow ε̇ = e/(Mτ) + ∫ e dt/(4Mτ²), e = σ_target − σ: critically damped for a packing of stiffness
/// M and without offset for a steady target. M = Σ kn d²/(9V) (2D: 4V) is the affine bulk modulus of the contacts at
/// hand (Walton 1987), τ the travel time of a wave of that modulus across the cell. |ε̇| ≤ stage.max_strain_rate; the
/// integral rests while the cap acts. Compression positive for x, y, z; shear rates are dv_x/dy and so on.
void control_cell(State& state, const StageSpec& stage, double dt);

/// Largest |σ − target| over |target| of the stage's stress targets (target 0: over the mean stress) [-]; 0 without
/// targets.
double stress_error(const State& state, const StageSpec& stage);

/// Stress components in the order x y z yz xz xy [Pa]: compression positive; shear positive when it drives a positive
/// rate.
std::array<double, 6> stress_components(const State& state);

/// Logarithmic strain of the cell since the stage began, x y z compression positive, then shear yz xz xy [-].
std::array<double, 6> stage_strain(const State& state);

/// (σx + σy + σz)/3, 2D: (σx + σy)/2 [Pa].
double mean_stress(const State& state);

}  // namespace eg
