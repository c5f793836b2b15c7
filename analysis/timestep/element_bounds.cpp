#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

#include "assembly/stiffness.hpp"
#include "timestep/estimates.hpp"

namespace eg {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Scales that turn K into M⁻¹K with rotations times R, or into M^−½KM^−½: a row and a column factor for
/// translations and for rotations of a grain.
struct Scales {
  std::array<double, 2> row, column;
};

Scales similarity_scales(const Network& network, Index grain, bool symmetric) {
  const double m = network.inverse_mass[grain];
  const double i = network.rotation ? network.inverse_inertia[grain] : 0.0;
  if (symmetric) return {{std::sqrt(m), std::sqrt(i)}, {std::sqrt(m), std::sqrt(i)}};
  const double r = network.radius[grain];
  return {{m, r * i}, {m > 0 ? 1.0 : 0.0, i > 0 ? 1 / r : 0.0}};
}

/// Largest sum of moduli in a row: blocks of the diagonal are summed first, couplings contact by contact.
double largest_row_sum(const Network& network, bool symmetric) {
  const auto components = active_components(network);
  std::vector<Matrix6> diagonal(network.size(), Matrix6::Zero());
  std::vector<Eigen::Matrix<double, 6, 1>> sums(network.size(), Eigen::Matrix<double, 6, 1>::Zero());
  const auto scaled = [&](Index a, Index b, Matrix6 block) {
    const Scales row = similarity_scales(network, a, symmetric), column = similarity_scales(network, b, symmetric);
    block.topRows<3>() *= row.row[0];
    block.bottomRows<3>() *= row.row[1];
    block.leftCols<3>() *= column.column[0];
    block.rightCols<3>() *= column.column[1];
    return block;
  };
  const auto add_coupling = [&](Index a, Index b, const Matrix6& block) {
    const Matrix6 s = scaled(a, b, block);
    for (const int r : components)
      for (const int c : components) sums[a](r) += std::abs(s(r, c));
  };
  for (const Spring& s : network.springs) {
    const Eigen::Matrix3d k = contact_stiffness(s);
    auto b_i = side_matrix(s, ContactSide::first);
    const auto b_j = side_matrix(s, ContactSide::second);
    if (s.i == s.j) b_i += b_j;
    diagonal[s.i] += b_i.transpose() * k * b_i;
    if (s.j == no_index || s.i == s.j) continue;
    diagonal[s.j] += b_j.transpose() * k * b_j;
    const Matrix6 coupling = b_i.transpose() * k * b_j;
    add_coupling(s.i, s.j, coupling);
    add_coupling(s.j, s.i, coupling.transpose());
  }
  double largest = 0;
  for (std::size_t g = 0; g < network.size(); ++g) {
    const auto grain = static_cast<Index>(g);
    add_coupling(grain, grain, diagonal[g]);
    largest = std::max(largest, sums[g].maxCoeff());
  }
  return largest;
}

}  // namespace

double element_time_step(const Network& network) {
  const auto z = coordination_numbers(network);
  double largest = 0, largest_couple = 0;  // an element is a contact with its couple: not above the sum of both
  for (const Spring& s : network.springs) {
    if (s.couple) {
      double share = z[s.i] * network.inverse_inertia[s.i];
      if (s.j != no_index) share += z[s.j] * network.inverse_inertia[s.j];
      largest_couple = std::max(largest_couple, std::max(s.normal, s.tangential) * share);
      continue;
    }
    double normal = 0, tangential = 0;
    const auto add = [&](Index grain, double arm) {
      const double share = z[grain] * network.inverse_mass[grain];
      normal += share;
      tangential += share + (network.rotation ? z[grain] * arm * arm * network.inverse_inertia[grain] : 0.0);
    };
    add(s.i, s.arm_i);
    if (s.j != no_index) add(s.j, s.arm_j);
    largest = std::max({largest, s.normal * normal, s.tangential * tangential});
  }
  return 2 / std::sqrt(largest + largest_couple);
}

double gershgorin_time_step(const Network& network) {
  return 2 / std::sqrt(std::min(largest_row_sum(network, false), largest_row_sum(network, true)));
}

}  // namespace eg
