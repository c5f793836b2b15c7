#pragma once
// Forces and energies of a packing as a whole. Stress is positive in compression.
#include <span>
#include <vector>

#include "state/gather.hpp"

namespace eg {

/// σ = (1/V) Σ f⊗l over contacts, f the force on j and l the branch from i to j; a wall's branch ends at its plane
/// [Pa] (2D: N/m). In equilibrium without body forces its columns are the tractions on the faces of V.
Mat3 stress(std::span<const ContactPoint>, double volume);

/// Force of contacts, gravity and what is applied from outside on every grain [N], contacts' dashpots left out; zero
/// for fixed grains.
std::vector<Vec3> net_forces(const State&, std::span<const ContactPoint>, const Vec3& gravity);

/// Mean |net force| of the grains that can move over mean |contact force| [-]; 1 without contacts.
double unbalanced_force(const State&, std::span<const ContactPoint>, const Vec3& gravity);

/// Σ ½ m c² + ½ I ω² [J] (2D: J/m), c the peculiar velocity of the last half step; fixed grains carry none.
double kinetic_energy(const State&);

/// Energy of the normal springs plus T²/(2 kt) of the tangential ones [J]. The tangential part is exact for the linear
/// law only: an incremental law whose kt changes with N has no potential (Elata and Berryman 1996).
double elastic_energy(std::span<const ContactPoint>);

/// The rate that inertia is judged by [1/s]: the largest |rate| among the components of the cell that the stage drives
/// at a rate, so that what answers in the test (the lateral strain under constant p, say) does not count (Lopera Perez
/// et al. 2016); of all components when the stage drives none so. Axial and engineering shear rates alike.
double driving_rate(const State&, const StageSpec&);

/// I = ε̇ d √(ρ/p), ε̇ [1/s], d [m], ρ of the grains [kg/m³], p > 0 [Pa] (GDR MiDi 2004). Quasi-static below some 1e-3.
double inertial_number(double strain_rate, double diameter, double density, double mean_stress);

}  // namespace eg
