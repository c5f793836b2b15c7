#pragma once
// Stiffness and mass of a network as matrices. Degrees of freedom: grain after grain in the order of the network,
// dofs_per_grain() each: 3D ux uy uz θx θy θz, 2D ux uy θz, without rotation the translations only. Displacements [m],
// rotations [rad].
#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <span>
#include <vector>

#include "assembly/network.hpp"

namespace eg {

/// Which of (ux, uy, uz, θx, θy, θz) are degrees of freedom of a grain; as many as network.dofs_per_grain().
std::span<const int> active_components(const Network& network);

/// All degrees of freedom of the network, those of fixed grains included.
inline std::size_t total_dofs(const Network& network) {
  return network.size() * static_cast<std::size_t>(network.dofs_per_grain());
}

enum class ContactSide { first, second };  ///< grain i, grain j

/// B of one grain's side: Δ = B_i (u_i, θ_i) + B_j (u_j, θ_j).
Eigen::Matrix<double, 3, 6> side_matrix(const Spring& spring, ContactSide side);

/// k = kn nnᵀ + kt (1 − nnᵀ) in global axes, so that K_c = Bᵀ k B [N/m].
Eigen::Matrix3d contact_stiffness(const Spring& spring);

/// K, elastic mode (every contact sticks), both triangles, every block of a pair stored in full. Fixed grains keep
/// their rows.
Eigen::SparseMatrix<double> stiffness_matrix(const Network& network);

/// New values into a matrix that stiffness_matrix() made for the same pairs of grains.
void refill_stiffness(const Network& network, Eigen::SparseMatrix<double>& matrix);

/// The block of every grain on the diagonal of K, dofs_per_grain()² numbers each, symmetric.
std::vector<double> diagonal_blocks(const Network& network);

/// Diagonal of M⁻¹ [1/kg and 1/(kg m²)]; 0 for what cannot move.
std::vector<double> inverse_mass_diagonal(const Network& network);

/// M^−½ K M^−½ [1/s²] as a dense matrix, for small networks (memory 8 total_dofs()² bytes).
Eigen::MatrixXd dense_scaled_stiffness(const Network& network);

}  // namespace eg
