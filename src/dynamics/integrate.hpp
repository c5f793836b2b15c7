#pragma once
// Leapfrog: positions at t, velocities at t ± dt/2 (Verlet 1967). Velocities are peculiar, c = v − L·x.
#include "dynamics/force_loop.hpp"
#include "search/travel.hpp"

namespace eg {

struct KickOptions {
  double local = 0, mass = 0;  ///< damping α [-], c [1/s]
  Vec3 gravity;                ///< [m/s²]
  int dimension = 3;
};

/// x ← exp(L dt) x + dt c, cell and walls with it; tells `blocks` how far.
void drift(State& state, double dt, Blocks& blocks);

/// Velocities of bodies along the axes in which they are free, by the forces of the grains, with the same damping.
KickSums kick_bodies(State& state, double dt, const KickOptions& options);

/// c ← c + dt (F/m + g − L c) with damping, ω likewise, for the grains of one chunk; dt is the span between the half
/// steps on both sides. Uses up the forces: rows of the workspace are zero afterwards. `works`: fills
/// work.kick_sums[chunk].
void kick_chunk(State& state, ForceWorkspace& work, std::size_t chunk, double dt, const KickOptions& options,
                bool works);

}  // namespace eg
