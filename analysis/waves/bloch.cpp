#include "waves/bloch.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <complex>
#include <numbers>

#include "assembly/stiffness.hpp"

namespace eg {
namespace {

using Complex = std::complex<double>;

/// Adds block (p, q) of the active components.
template <class Block>
void add_block(Eigen::MatrixXcd& matrix, std::span<const int> components, Index p, Index q, const Block& block) {
  const auto d = components.size();
  for (std::size_t c = 0; c < d; ++c)
    for (std::size_t r = 0; r < d; ++r)
      matrix(static_cast<Eigen::Index>(p * d + r), static_cast<Eigen::Index>(q * d + c)) +=
          block(components[r], components[c]);
}

Eigen::VectorXd inverse_root_masses(const Network& network) {
  const auto inverse = inverse_mass_diagonal(network);
  return Eigen::Map<const Eigen::VectorXd>(inverse.data(), static_cast<Eigen::Index>(inverse.size())).cwiseSqrt();
}

BlochMode describe(const Network& network, double square, const Eigen::VectorXcd& vector, double mass) {
  BlochMode mode{.square = square};
  const auto components = active_components(network);
  std::array<Complex, 3> sum{};
  Eigen::Index row = 0;
  for (std::size_t g = 0; g < network.size(); ++g)
    for (const int c : components) {
      const Complex value = vector(row++);
      if (c >= 3)
        mode.rotation += std::norm(value);
      else if (network.inverse_mass[g] > 0)
        sum[static_cast<std::size_t>(c)] += value / std::sqrt(network.inverse_mass[g]);
    }
  for (std::size_t c = 0; c < 3; ++c) mode.mean[c] = std::norm(sum[c]) / mass;
  return mode;
}

}  // namespace

double BlochMode::frequency() const { return std::sqrt(std::max(square, 0.0)) / (2 * std::numbers::pi); }

Eigen::MatrixXcd bloch_matrix(const Network& network, const Vec3& k) {
  const auto size = static_cast<Eigen::Index>(total_dofs(network));
  const auto components = active_components(network);
  Eigen::MatrixXcd matrix = Eigen::MatrixXcd::Zero(size, size);
  for (const Spring& s : network.springs) {
    const Eigen::Matrix3d stiffness = contact_stiffness(s);
    const auto b_i = side_matrix(s, ContactSide::first), b_j = side_matrix(s, ContactSide::second);
    const Complex phase = std::polar(1.0, dot(k, s.n) * s.length);
    const Eigen::Matrix<Complex, 6, 6> coupling = (b_i.transpose() * stiffness * b_j).cast<Complex>() * phase;
    add_block(matrix, components, s.i, s.i, Eigen::Matrix<double, 6, 6>(b_i.transpose() * stiffness * b_i));
    add_block(matrix, components, s.j, s.j, Eigen::Matrix<double, 6, 6>(b_j.transpose() * stiffness * b_j));
    add_block(matrix, components, s.i, s.j, coupling);
    add_block(matrix, components, s.j, s.i, Eigen::Matrix<Complex, 6, 6>(coupling.adjoint()));
  }
  const Eigen::VectorXd scale = inverse_root_masses(network);
  return scale.asDiagonal() * matrix * scale.asDiagonal();
}

std::vector<BlochMode> bloch_modes(const Network& network, const Vec3& k) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXcd> solver(bloch_matrix(network, k));
  double mass = 0;
  for (const double inverse : network.inverse_mass) mass += inverse > 0 ? 1 / inverse : 0;
  std::vector<BlochMode> modes;
  for (Eigen::Index m = 0; m < solver.eigenvalues().size(); ++m)
    modes.push_back(describe(network, solver.eigenvalues()(m), solver.eigenvectors().col(m), mass));
  return modes;
}

}  // namespace eg
