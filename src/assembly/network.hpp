#pragma once
// The linearised packing: one spring triple a contact. Everything that asks for K or M starts here.
//
// Relative displacement of a contact (j against i, n from i to j):  Δ = u_j − u_i − (a_i θ_i + a_j θ_j) × n,
// elastic energy ½ kn (n·Δ)² + ½ kt |Δ − n(n·Δ)|², so K_c = Bᵀ diag(kn, kt, kt) B: every contact sticks.
#include <algorithm>
#include <vector>

#include "base/vec.hpp"

namespace eg {

struct Spring {
  Index i = 0, j = 0;                 ///< grains; j == no_index: a fixed wall. i == j is possible (image of itself)
  double arm_i = 0, arm_j = 0;        ///< a [m]; arm_j = 0 for a wall
  double normal = 0, tangential = 0;  ///< kn, kt [N/m]
  Vec3 n;                             ///< unit, from i to j
  double length = 0;  ///< of the branch [m]: distance of the centres; wall: of the centre from its plane
  double give = 1;    ///< how many times its stiffness counts in an upper bound of λmax: more than once where the wall
                      ///< answers forces (docs/walls.md)
  /// A spring of couples instead: Δ = θ_j − θ_i, `normal` the stiffness against twisting, `tangential` that against
  /// rolling [N m]; the arms mean nothing.
  bool couple = false;
};

/// Masses enter as inverses: 0 is a grain that cannot move (or turn). Order of grains as in State::grains.
struct Network {
  int dimension = 3;                    ///< degrees of freedom a grain: 3D ux uy uz θx θy θz; 2D ux uy θz
  bool rotation = true;                 ///< false: translations only (3 or 2)
  std::vector<double> inverse_mass;     ///< [1/kg]
  std::vector<double> inverse_inertia;  ///< [1/(kg m²)]; empty when !rotation
  std::vector<double> radius;           ///< [m]
  std::vector<Index> id;                ///< the user's numbers
  std::vector<Spring> springs;          ///< one a contact, then the couples of contacts that have them

  std::size_t size() const { return inverse_mass.size(); }
  std::size_t contacts() const {
    return static_cast<std::size_t>(
        std::count_if(springs.begin(), springs.end(), [](const Spring& s) { return !s.couple; }));
  }
  int dofs_per_grain() const { return dimension == 3 ? (rotation ? 6 : 3) : (rotation ? 3 : 2); }
};

}  // namespace eg
