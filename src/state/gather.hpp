#pragma once
// The contacts of a state as the laws see them, for everything that looks at a packing without moving it.
#include <cmath>
#include <functional>
#include <span>
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
  double give = 1;                ///< by how much stiffer it counts in a bound of the step, its body answering forces
  double rolling = 0, twisting = 0;            ///< stiffness against rotation of j against i, across, about n [N m]
  double normal_energy = 0, shear_energy = 0;  ///< stored in the normal spring and in all others [J]
  bool bonded = false;

  Vec3 force() const { return geometry.n * normal.force - shear; }  ///< on j [N]
  bool has_couple() const { return rolling > 0 || twisting > 0; }
  bool sliding() const { return !bonded && norm(shear) >= limit * (1 - 1e-9); }
};

/// Calls visit for every contact that touches or is bonded. Order: grain contacts as listed, then walls.
void visit_contacts(const Scene& scene, const State& state, const std::function<void(const ContactPoint&)>& visit);

/// Places in State::contacts and State::wall_contacts, ascending.
struct ContactSelection {
  std::span<const std::size_t> grains, walls;
};

/// The same for some contacts only.
void visit_contacts(const Scene& scene, const State& state, const ContactSelection& selection,
                    const std::function<void(const ContactPoint&)>& visit);

Arms arms_of(const Scene& scene);

}  // namespace eg
