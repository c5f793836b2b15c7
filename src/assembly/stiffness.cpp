#include "assembly/stiffness.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace eg {
namespace {

using Block = Eigen::Matrix<double, 6, 6>;

Eigen::Vector3d eigen_vector(const Vec3& v) { return {v.x, v.y, v.z}; }

/// Calls add(row grain, column grain, block) for the blocks of one spring.
template <class Add>
void for_each_block(const Spring& spring, Add add) {
  const Eigen::Matrix3d k = contact_stiffness(spring);
  const auto b_i = side_matrix(spring, ContactSide::first);
  add(spring.i, spring.i, Block(b_i.transpose() * k * b_i));
  if (spring.j == no_index) return;
  const auto b_j = side_matrix(spring, ContactSide::second);
  const Block coupling = b_i.transpose() * k * b_j;
  add(spring.i, spring.j, coupling);
  add(spring.j, spring.i, Block(coupling.transpose()));
  add(spring.j, spring.j, Block(b_j.transpose() * k * b_j));
}

/// For every grain: itself and the grains it shares a spring with, ascending, each once.
std::vector<std::vector<Index>> neighbours(const Network& network) {
  std::vector<std::vector<Index>> lists(network.size());
  for (std::size_t g = 0; g < network.size(); ++g) lists[g].push_back(static_cast<Index>(g));
  for (const Spring& s : network.springs) {
    if (s.j == no_index) continue;
    lists[s.i].push_back(s.j);
    lists[s.j].push_back(s.i);
  }
  for (auto& list : lists) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return lists;
}

}  // namespace

std::span<const int> active_components(const Network& network) {
  static constexpr std::array<int, 6> solid{0, 1, 2, 3, 4, 5};
  static constexpr std::array<int, 3> plane{0, 1, 5};
  if (network.dimension == 3) return std::span(solid).first(network.rotation ? 6 : 3);
  return std::span(plane).first(network.rotation ? 3 : 2);
}

Eigen::Matrix<double, 3, 6> side_matrix(const Spring& spring, ContactSide side) {
  const bool first = side == ContactSide::first;
  if (spring.couple) {
    Eigen::Matrix<double, 3, 6> b = Eigen::Matrix<double, 3, 6>::Zero();
    b.rightCols<3>() = (first ? -1.0 : 1.0) * Eigen::Matrix3d::Identity();
    return b;
  }
  const Vec3 an = (first ? spring.arm_i : spring.arm_j) * spring.n;
  Eigen::Matrix<double, 3, 6> b;
  b.leftCols<3>() = (first ? -1.0 : 1.0) * Eigen::Matrix3d::Identity();
  b.rightCols<3>() << 0, -an.z, an.y, an.z, 0, -an.x, -an.y, an.x, 0;  // −a θ×n = a n×θ
  return b;
}

Eigen::Matrix3d contact_stiffness(const Spring& spring) {
  const Eigen::Vector3d n = eigen_vector(spring.n);
  return spring.tangential * Eigen::Matrix3d::Identity() + (spring.normal - spring.tangential) * n * n.transpose();
}

Eigen::SparseMatrix<double> stiffness_matrix(const Network& network) {
  const auto lists = neighbours(network);
  const auto d = static_cast<std::size_t>(network.dofs_per_grain());
  const auto size = static_cast<Eigen::Index>(total_dofs(network));
  Eigen::SparseMatrix<double> matrix(size, size);
  std::size_t entries = 0;
  for (const auto& list : lists) entries += d * d * list.size();
  matrix.resizeNonZeros(static_cast<Eigen::Index>(entries));
  int* outer = matrix.outerIndexPtr();
  int* inner = matrix.innerIndexPtr();
  *outer = 0;
  for (const auto& list : lists)
    for (std::size_t column = 0; column < d; ++column) {
      for (const Index grain : list)
        for (std::size_t row = 0; row < d; ++row) *inner++ = static_cast<int>(grain * d + row);
      outer[1] = outer[0] + static_cast<int>(d * list.size());
      ++outer;
    }
  refill_stiffness(network, matrix);
  return matrix;
}

void refill_stiffness(const Network& network, Eigen::SparseMatrix<double>& matrix) {
  const auto components = active_components(network);
  const auto d = components.size();
  const int* outer = matrix.outerIndexPtr();
  const int* inner = matrix.innerIndexPtr();
  double* value = matrix.valuePtr();
  std::fill_n(value, matrix.nonZeros(), 0.0);
  const auto add = [&](Index row_grain, Index column_grain, const Block& block) {
    for (std::size_t c = 0; c < d; ++c) {
      const std::size_t column = column_grain * d + c;
      const int first_row = static_cast<int>(row_grain * d);
      const int* found = std::lower_bound(inner + outer[column], inner + outer[column + 1], first_row);
      assert(found != inner + outer[column + 1] && *found == first_row);
      double* target = value + (found - inner);
      for (std::size_t r = 0; r < d; ++r) target[r] += block(components[r], components[c]);
    }
  };
  for (const Spring& spring : network.springs) for_each_block(spring, add);
}

std::vector<double> diagonal_blocks(const Network& network) {
  const auto components = active_components(network);
  const auto d = components.size();
  std::vector<double> blocks(network.size() * d * d, 0.0);
  // With B = [s 1, a n×]: Bᵀk B = [k, s a kt n×; ·, a² kt (1 − nnᵀ)]; a grain and its own image move alike (s = 0).
  const auto add = [&](Index grain, const Spring& spring, double sign, double arm) {
    const Vec3& n = spring.n;
    const double kt = spring.tangential, turn = arm * arm * kt, mixed = sign * arm * kt;
    const Vec3 cross_rows[3] = {{0, -n.z, n.y}, {n.z, 0, -n.x}, {-n.y, n.x, 0}};
    double* block = &blocks[grain * d * d];
    for (std::size_t p = 0; p < d; ++p)
      for (std::size_t q = 0; q < d; ++q) {
        const int r = components[p], c = components[q];
        const double same = r % 3 == c % 3 ? 1.0 : 0.0, nn = n[r % 3] * n[c % 3];
        if (r < 3 && c < 3) block[p * d + q] += std::abs(sign) * (kt * same + (spring.normal - kt) * nn);
        if (r >= 3 && c >= 3) block[p * d + q] += turn * (same - nn);
        if (r < 3 && c >= 3) block[p * d + q] += mixed * cross_rows[r][c - 3];
        if (r >= 3 && c < 3) block[p * d + q] += mixed * cross_rows[c][r - 3];
      }
  };
  const auto add_couple = [&](Index grain, const Spring& s) {
    for (std::size_t p = 0; p < d; ++p)
      for (std::size_t q = 0; q < d; ++q)
        if (const int r = components[p], c = components[q]; r >= 3 && c >= 3)
          blocks[grain * d * d + p * d + q] +=
              (r == c ? s.tangential : 0.0) + (s.normal - s.tangential) * s.n[r - 3] * s.n[c - 3];
  };
  for (const Spring& s : network.springs) {
    if (s.couple) {
      if (s.i == s.j) continue;
      add_couple(s.i, s);
      if (s.j != no_index) add_couple(s.j, s);
      continue;
    }
    if (s.i == s.j) {
      add(s.i, s, 0, s.arm_i + s.arm_j);
      continue;
    }
    add(s.i, s, -1, s.arm_i);
    if (s.j != no_index) add(s.j, s, 1, s.arm_j);
  }
  return blocks;
}

std::vector<double> inverse_mass_diagonal(const Network& network) {
  std::vector<double> diagonal;
  diagonal.reserve(total_dofs(network));
  for (std::size_t g = 0; g < network.size(); ++g)
    for (const int component : active_components(network))
      diagonal.push_back(component < 3 ? network.inverse_mass[g] : network.inverse_inertia[g]);
  return diagonal;
}

Eigen::MatrixXd dense_scaled_stiffness(const Network& network) {
  const auto components = active_components(network);
  const auto d = components.size();
  const auto size = static_cast<Eigen::Index>(total_dofs(network));
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
  const auto add = [&](Index row_grain, Index column_grain, const Block& block) {
    for (std::size_t c = 0; c < d; ++c)
      for (std::size_t r = 0; r < d; ++r)
        matrix(static_cast<Eigen::Index>(row_grain * d + r), static_cast<Eigen::Index>(column_grain * d + c)) +=
            block(components[r], components[c]);
  };
  for (const Spring& spring : network.springs) for_each_block(spring, add);
  const auto inverse_mass = inverse_mass_diagonal(network);
  const Eigen::VectorXd scale =
      Eigen::Map<const Eigen::VectorXd>(inverse_mass.data(), static_cast<Eigen::Index>(inverse_mass.size()))
          .cwiseSqrt();
  return scale.asDiagonal() * matrix * scale.asDiagonal();
}

}  // namespace eg
