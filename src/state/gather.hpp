#pragma once
// The contacts of a state as the laws see them, for everything that looks at a packing without moving it.
#include <functional>
#include <vector>

#include "contact/interaction.hpp"
#include "state/scene.hpp"
#include "state/state.hpp"

namespace eg {

struct ContactPoint {
  Index i = 0, j = 0;     ///< j == no_index: a wall
  Index wall = no_index;  ///< number of the wall
  std::size_t entry = 0;  ///< place in State::contacts or State::wall_contacts
  Vec3 branch;            ///< x_j − x_i [m]; wall: from the centre to the contact plane
  Geometry<double> geometry;
  NormalResponse<double> normal;  ///< N, kn, kt
  Vec3 shear;                     ///< T [N], acts on i as +T; force on j is N n − T
  double limit = 0;               ///< µN [N]
  double normal_energy = 0;       ///< [J]

  Vec3 force() const { return geometry.n * normal.force - shear; }  ///< on j [N]
  bool sliding() const { return norm(shear) >= limit * (1 - 1e-9); }
};

/// How far pairs are looked at beyond what touches now: every overlap is taken larger by this.
using OverlapGrowth = std::function<double(Index i, Index j, const Geometry<double>&)>;

/// Calls visit for every contact that touches (with `growth`: whose overlap plus growth is positive; N, kn and kt are
/// then those of the larger overlap). Order: grain contacts as listed, then walls.
void visit_contacts(const Scene& scene, const State& state, const std::function<void(const ContactPoint&)>& visit,
                    const OverlapGrowth& growth = {});

Arms arms_of(const Scene& scene);

}  // namespace eg
