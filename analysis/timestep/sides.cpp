#include "timestep/sides.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <numeric>

namespace eg {
namespace {

bool can_move(const Network& network, Index grain) {
  return network.inverse_mass[grain] > 0 || (network.rotation && network.inverse_inertia[grain] > 0);
}

/// A sum of positive semidefinite terms has an error below (terms + operations a term) ε times the sum of their traces,
/// which is the trace of the sum.
double summation_error(const Block& block, std::size_t terms) {
  return (8.0 * static_cast<double>(terms) + 64.0) * std::numeric_limits<double>::epsilon() * block.trace();
}

}  // namespace

Sides::Sides(const Network& network)
    : network_(network), begin_(network.size() + 1, 0), split_(network.springs.size(), 0) {
  active_.setZero();
  for (const int component : active_components(network)) active_(component) = 1;
  const auto& springs = network.springs;
  for (const Spring& s : springs) {  // begin_[g + 1]: how many of grain g
    if (can_move(network, s.i)) ++begin_[s.i + 1];
    if (s.j != no_index && s.j != s.i && can_move(network, s.j)) ++begin_[s.j + 1];
  }
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  sides_.resize(begin_.back());
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  for (std::size_t c = 0; c < springs.size(); ++c) {
    const Spring& s = springs[c];
    const auto spring = static_cast<Index>(c);
    const bool moves_i = can_move(network, s.i), moves_j = s.j != no_index && can_move(network, s.j);
    using enum Side::Role;
    split_[c] = moves_i && moves_j && s.i != s.j;
    if (moves_i) sides_[next[s.i]++] = {spring, split_[c] ? first : alone, ContactSide::first, s.i == s.j};
    if (moves_j && s.i != s.j) sides_[next[s.j]++] = {spring, moves_i ? second : alone, ContactSide::second, false};
  }
}

Eigen::Matrix<double, 6, 1> Sides::scale(std::size_t grain) const {
  Eigen::Matrix<double, 6, 1> scale = active_;
  scale.head<3>() *= std::sqrt(network_.inverse_mass[grain]);
  scale.tail<3>() *= network_.rotation ? std::sqrt(network_.inverse_inertia[grain]) : 0.0;
  return scale;
}

Eigen::Matrix<double, 3, 6> Sides::scaled_matrix(std::size_t grain, const Side& side) const {
  const Spring& spring = network_.springs[side.spring];
  Eigen::Matrix<double, 3, 6> b = side_matrix(spring, side.matrix);
  if (side.own_image) b += side_matrix(spring, ContactSide::second);
  return b * scale(grain).asDiagonal();
}

double block_upper_bound(const Block& block, std::size_t terms) {
  const Eigen::SelfAdjointEigenSolver<Block> solver(block, Eigen::EigenvaluesOnly);
  return solver.eigenvalues()(5) + 2 * summation_error(block, terms);
}

bool block_is_below(const Block& block, std::size_t terms, double sigma) {
  const double margin = summation_error(block, terms) + 64 * std::numeric_limits<double>::epsilon() * sigma;
  const Block rest = (sigma - margin) * Block::Identity() - block;
  return rest.diagonal().minCoeff() > 0 && rest.llt().info() == Eigen::Success;
}

}  // namespace eg
