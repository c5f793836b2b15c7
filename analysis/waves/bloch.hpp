#pragma once
// Bloch waves of a periodic network: u_j = U_j exp(i k·x_j), so D(k) U = ω² M U with the Hermitian
// D(k) = Σ_c B_c(k)ᴴ k_c B_c(k), where side j of a contact carries exp(i k·branch). With places in the phase (and not
// the cell's edges alone) the modes of a supercell keep the wave vector that they would have in the primitive cell.
#include <Eigen/Core>
#include <array>
#include <vector>

#include "assembly/network.hpp"

namespace eg {

/// One wave at one wave vector.
struct BlochMode {
  double square = 0;             ///< ω² [1/s²], may be −0 by round-off
  double rotation = 0;           ///< share of the kinetic energy in rotation [0, 1]
  std::array<double, 3> mean{};  ///< share in the mean motion of the cell along x, y, z: 1 for a rigid translation

  double frequency() const;  ///< ω/2π [Hz]
};

/// M^−½ D(k) M^−½ [1/s²]; rows as in assembly/stiffness.hpp. k [rad/m].
Eigen::MatrixXcd bloch_matrix(const Network& network, const Vec3& k);

/// All modes at k, slowest first; total_dofs() of them. O(rows³).
std::vector<BlochMode> bloch_modes(const Network& network, const Vec3& k);

}  // namespace eg
