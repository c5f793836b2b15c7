#pragma once
// From a state to its linearised network, and to the exact tangent of its forces. Uses the laws, never the dynamics.
#include <Eigen/SparseCore>
#include <vector>

#include "assembly/network.hpp"
#include "state/gather.hpp"

namespace eg {

/// Elastic mode: every touching contact sticks; kn, kt of the present overlap. Throws nothing; a state without contacts
/// gives no springs.
Network linearise(const Scene& scene, const State& state);

/// The grains without their contacts.
Network bare_network(const Scene& scene, const State& state);

/// The spring of one contact, with the stiffness that it was visited with.
Spring spring_of(const ContactPoint& contact);
/// Its spring of couples, where it has one.
Spring couple_of(const ContactPoint& contact);

/// Exact derivative of one contact's forces, K_c = −∂(F_i, M_i, F_j, M_j)/∂(u_i, θ_i, u_j, θ_j): 12×12, row major.
/// Sliding, geometric terms and history updates included; j == no_index for a wall (its rows and columns are zero).
struct TangentBlock {
  Index i = 0, j = 0;
  std::array<double, 144> k{};
};

/// Consistent mode: the blocks of all touching contacts, by automatic differentiation of the same function that the
/// force loop runs. Nonsymmetric where contacts slide.
std::vector<TangentBlock> consistent_blocks(const Scene& scene, const State& state);

/// The blocks added up: dofs_per_grain() rows a grain in the order of Network (2D: ux uy θz).
Eigen::SparseMatrix<double> assemble_blocks(const std::vector<TangentBlock>& blocks, const Network& shape);

}  // namespace eg
