// Block-Jacobi with clusters of grains: against the dense matrix, and where blocks of single grains stall.
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "../support/networks.hpp"
#include "assembly/apply.hpp"
#include "assembly/stiffness.hpp"
#include "eigen/conjugate_gradient.hpp"
#include "stiffness/cluster_jacobi.hpp"

namespace eg {
namespace {

struct Case {
  int dimension;
  bool rotation;
};
class Clusters : public testing::TestWithParam<Case> {};

TEST_P(Clusters, InvertTheirBlocksOfK) {
  const auto [dimension, rotation] = GetParam();
  const Network net = test::random_network({dimension, rotation, 80, 3, -1, .1, 0, 1.5}, 11);
  const ClusterJacobi precondition(net);
  ASSERT_FALSE(precondition.clusters().empty());
  const Eigen::MatrixXd k = stiffness_matrix(net);
  const auto r = random_unit_vector(total_dofs(net), 3);
  std::vector<double> z(r.size());
  precondition.apply(r, z);
  const auto d = static_cast<std::size_t>(net.dofs_per_grain());
  for (const auto& cluster : precondition.clusters()) {
    ASSERT_GE(cluster.size(), 2u);
    std::vector<Eigen::Index> rows;
    for (const Index g : cluster)
      for (std::size_t c = 0; c < d; ++c) rows.push_back(static_cast<Eigen::Index>(g * d + c));
    const Eigen::MatrixXd block = k(rows, rows);
    if (block.fullPivLu().rank() < block.rows()) continue;
    const auto n = static_cast<Eigen::Index>(r.size());
    const Eigen::VectorXd in = Eigen::Map<const Eigen::VectorXd>(r.data(), n)(rows);
    const Eigen::VectorXd out = Eigen::Map<const Eigen::VectorXd>(z.data(), n)(rows);
    EXPECT_LE((block * out - in).norm(), 1e-4 * in.norm());
  }
}

INSTANTIATE_TEST_SUITE_P(All, Clusters, testing::Values(Case{3, true}, Case{3, false}, Case{2, true}, Case{2, false}));

/// A lattice, and many pairs of grains between two of its grains each, all but in line: they buckle almost freely.
Network lattice_with_chains(double kink) {
  Network net = test::lattice_network("fcc", 4, 1, .8, true);
  const auto grains = static_cast<Index>(net.size());
  for (Index chain = 0; chain < 20; ++chain) {
    const Index a = grains + 2 * chain, from = 7 * chain, to = 7 * chain + 3;
    for (int k = 0; k < 2; ++k) {
      net.inverse_mass.push_back(1), net.inverse_inertia.push_back(10), net.radius.push_back(.5);
      net.id.push_back(a + static_cast<Index>(k));
    }
    const double off = kink * (1 + chain);
    const Vec3 n{std::cos(off), std::sin(off), 0};
    net.springs.push_back({from, a, .5, .5, 1, .8, n, 1});
    net.springs.push_back({a, a + 1, .5, .5, 1, .8, {1, 0, 0}, 1});
    net.springs.push_back({to, a + 1, .5, .5, 1, .8, {-n.x, 0, -n.y}, 1});
    net.springs.push_back({static_cast<Index>(to + 1), a + 1, .5, .5, .9, .7, {0, n.x, n.y}, 1});
  }
  return net;
}

TEST(ClusterJacobi, ChainsAlmostInLineDoNotStall) {
  const auto iterations = [](double kink, const auto& make) {
    const Network net = lattice_with_chains(kink);
    const StiffnessOperator k(net, StiffnessOperator::Scaling::none);
    std::vector<double> b(k.rows()), x(k.rows());
    k.apply(random_unit_vector(k.rows(), 5), b);
    const auto done = conjugate_gradient(k, make(net), b, x, {1e-10});
    EXPECT_TRUE(done.converged);
    return done.iterations;
  };
  const auto clusters = [](const Network& net) { return ClusterJacobi(net); };
  const auto grains = [](const Network& net) { return BlockJacobi(diagonal_blocks(net), 6); };
  const int straight = iterations(1e-3, clusters), bent = iterations(2e-2, clusters);
  EXPECT_LE(straight, bent + 10);
  EXPECT_GE(iterations(1e-3, grains), 2 * straight);
}

// Two grains on top of each other and nothing else: twist moves no contact, the block is singular.
TEST(ClusterJacobi, SingularClustersDoNoHarm) {
  Network net;
  net.inverse_mass = {1, 1}, net.inverse_inertia = {1, 1}, net.radius = {1, 1}, net.id = {0, 1};
  net.springs = {{0, 1, 1, 1, 5, 2, {0, 0, 1}, 2}, {0, no_index, 1, 0, 5, 2, {0, 0, -1}, 1}};
  const ClusterJacobi precondition(net);
  EXPECT_EQ(precondition.clusters().size(), 1u);
  const StiffnessOperator k(net, StiffnessOperator::Scaling::none);
  std::vector<double> b(12), x(12);
  k.apply(random_unit_vector(12, 5), b);
  const auto done = conjugate_gradient(k, precondition, b, x, {1e-10});
  EXPECT_TRUE(done.converged);
  EXPECT_LE(done.iterations, 12);
}

}  // namespace
}  // namespace eg
