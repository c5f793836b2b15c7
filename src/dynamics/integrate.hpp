#pragma once
// Leapfrog: positions at t, velocities at t ± dt/2 (Verlet 1967). Velocities are peculiar, c = v − L·x.
#include "dynamics/force_loop.hpp"

namespace eg {

struct KickOptions {
  double local = 0, mass = 0;  ///< damping α [-], c [1/s]
  Vec3 gravity;                ///< [m/s²]
  int dimension = 3;
};

/// Sums over grains of one kick. Works are exact for the discrete motion: F·(c₋ + c₊)/2 dt.
struct KickSums {
  double kinetic = 0;  ///< ½ Σ m c₋·c₊ + ½ Σ I ω₋·ω₊ at the time of the forces [J]
  double local_damping = 0, mass_damping = 0;  ///< dissipated [J]
  double body = 0;                             ///< work of gravity [J]
  double affine = 0;                           ///< work of the cell on peculiar motion, −m c·L·c dt [J]
  double unbalanced = 0;                       ///< Σ |net force| [N] over grains that can move
  KickSums& operator+=(const KickSums& b);
};

/// x ← x + dt (c + L x), cell and walls with it. Returns the largest peculiar displacement since contacts were
/// refreshed [m].
double drift(State& state, double dt);

/// c ← c + dt (F/m + g − L c) with damping, ω likewise; dt is the span between the half steps on both sides.
/// The sums are made only with `works`.
KickSums kick(State& state, const ForceWorkspace& work, double dt, const KickOptions& options, bool works);

}  // namespace eg
