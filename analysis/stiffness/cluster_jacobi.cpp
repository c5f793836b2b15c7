#include "stiffness/cluster_jacobi.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "assembly/stiffness.hpp"

namespace eg {
namespace {

constexpr double joined_above = 0.8;         // σ
constexpr std::size_t largest_cluster = 16;  // grains: 96² numbers
using SideMatrix = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 6>;

/// B of one side, columns of the degrees of freedom only.
SideMatrix active_side(const Network& network, const Spring& spring, ContactSide side) {
  const auto components = active_components(network);
  const auto whole = side_matrix(spring, side);
  SideMatrix b(3, static_cast<Eigen::Index>(components.size()));
  for (std::size_t k = 0; k < components.size(); ++k) b.col(static_cast<Eigen::Index>(k)) = whole.col(components[k]);
  return b;
}

/// σ² of a spring: the largest eigenvalue of P_i P_j, P = k^½ B D⁻¹ Bᵀ k^½ of either side.
double squared_coupling(const Network& network, const BlockJacobi& grains, const Spring& s) {
  const Eigen::Vector3d n(s.n.x, s.n.y, s.n.z);
  const double kt = std::sqrt(s.tangential);
  const Eigen::Matrix3d root = kt * Eigen::Matrix3d::Identity() + (std::sqrt(s.normal) - kt) * n * n.transpose();
  const auto part = [&](ContactSide side) -> Eigen::Matrix3d {
    const auto b = active_side(network, s, side);
    const Eigen::Index d = b.cols();
    const Eigen::Map<const Eigen::MatrixXd> inverse(grains.inverse(side == ContactSide::first ? s.i : s.j).data(), d,
                                                    d);
    return root * b * inverse * b.transpose() * root;
  };
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> first;
  first.computeDirect(part(ContactSide::first));
  const Eigen::Matrix3d half = first.eigenvectors() * first.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> both;
  both.computeDirect(half.transpose() * part(ContactSide::second) * half, Eigen::EigenvaluesOnly);
  return both.eigenvalues()(2);
}

/// Grains joined along the springs that couple most, strongest first, as far as clusters stay small.
std::vector<std::vector<Index>> find_clusters(const Network& network, const BlockJacobi& grains) {
  std::vector<std::pair<double, std::size_t>> strong;  // σ², spring
  for (std::size_t c = 0; c < network.springs.size(); ++c) {
    const Spring& s = network.springs[c];
    if (s.j == no_index || s.i == s.j) continue;
    if (const double coupling = squared_coupling(network, grains, s); coupling > joined_above * joined_above)
      strong.emplace_back(coupling, c);
  }
  std::stable_sort(strong.begin(), strong.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<Index> root(network.size()), size(network.size(), 1);
  std::iota(root.begin(), root.end(), Index{0});
  const auto root_of = [&](Index g) {
    while (root[g] != g) g = root[g] = root[root[g]];
    return g;
  };
  for (const auto& [coupling, c] : strong) {
    const Index a = root_of(network.springs[c].i), b = root_of(network.springs[c].j);
    if (a != b && size[a] + size[b] <= largest_cluster) root[b] = a, size[a] += size[b];
  }
  std::vector<std::vector<Index>> clusters;
  std::vector<std::size_t> place(network.size(), 0);  // of a root's cluster, from 1
  for (std::size_t g = 0; g < network.size(); ++g) {
    const Index r = root_of(static_cast<Index>(g));
    if (size[r] == 1) continue;
    if (place[r] == 0) clusters.emplace_back(), place[r] = clusters.size();
    clusters[place[r] - 1].push_back(static_cast<Index>(g));
  }
  return clusters;
}

/// The blocks of clusters out of K: those of the grains and what couples them.
std::vector<Eigen::MatrixXd> cluster_blocks(const Network& network, const std::vector<double>& diagonal,
                                            const std::vector<std::vector<Index>>& clusters) {
  const Eigen::Index d = network.dofs_per_grain();
  std::vector<Eigen::MatrixXd> blocks;
  std::vector<std::pair<std::size_t, Eigen::Index>> place(network.size(), {clusters.size(), 0});  // cluster, first row
  for (std::size_t k = 0; k < clusters.size(); ++k) {
    const auto rows = d * static_cast<Eigen::Index>(clusters[k].size());
    blocks.emplace_back(Eigen::MatrixXd::Zero(rows, rows));
    Eigen::Index row = 0;
    for (const Index g : clusters[k]) {
      blocks[k].block(row, row, d, d) =
          Eigen::Map<const Eigen::MatrixXd>(&diagonal[g * static_cast<std::size_t>(d * d)], d, d);
      place[g] = {k, row}, row += d;
    }
  }
  for (const Spring& s : network.springs) {
    if (s.j == no_index || s.i == s.j || place[s.i].first == clusters.size()) continue;
    const auto [cluster, i] = place[s.i];
    const auto [other, j] = place[s.j];
    if (cluster != other) continue;
    const Eigen::MatrixXd coupling = active_side(network, s, ContactSide::first).transpose() * contact_stiffness(s) *
                                     active_side(network, s, ContactSide::second);
    blocks[cluster].block(i, j, d, d) += coupling;
    blocks[cluster].block(j, i, d, d) += coupling.transpose();
  }
  return blocks;
}

}  // namespace

ClusterJacobi::ClusterJacobi(const Network& network) : grains_(diagonal_blocks(network), network.dofs_per_grain()) {
  clusters_ = find_clusters(network, grains_);
  for (auto& block : cluster_blocks(network, diagonal_blocks(network), clusters_)) {
    for (double& entry : block.diagonal()) entry = entry > 0 ? entry * (1 + 1e-8) : 1.0;  // it may be singular
    inverse_.emplace_back(block.llt().solve(Eigen::MatrixXd::Identity(block.rows(), block.cols())));
  }
}

void ClusterJacobi::apply(std::span<const double> r, std::span<double> z) const {
  grains_.apply(r, z);
  const auto d = static_cast<std::size_t>(grains_.width());
  Eigen::VectorXd in, out;
  for (std::size_t k = 0; k < clusters_.size(); ++k) {
    in.resize(inverse_[k].rows());
    Eigen::Index row = 0;
    for (const Index g : clusters_[k])
      for (std::size_t c = 0; c < d; ++c) in(row++) = r[g * d + c];
    out.noalias() = inverse_[k] * in;
    row = 0;
    for (const Index g : clusters_[k])
      for (std::size_t c = 0; c < d; ++c) z[g * d + c] = out(row++);
  }
}

}  // namespace eg
