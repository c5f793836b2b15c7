// Conjugate gradients and their preconditioner against dense linear algebra.
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "../support/networks.hpp"
#include "assembly/apply.hpp"
#include "assembly/stiffness.hpp"
#include "eigen/block_jacobi.hpp"
#include "eigen/conjugate_gradient.hpp"

namespace eg {
namespace {

struct Case {
  int dimension;
  bool rotation;
};
class Solve : public testing::TestWithParam<Case> {
 protected:
  Network network() const {
    return test::random_network({GetParam().dimension, GetParam().rotation, 80, 3, -1, .1, 0, 1.5}, 11);
  }
};

Eigen::VectorXd vector_of(const std::vector<double>& x) {
  return Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
}

TEST_P(Solve, DiagonalBlocksAreThoseOfTheMatrix) {
  Network net = network();
  net.springs.push_back({3, 3, .5, .5, 2, 1, {0, 0, 1}, 1});  // with its own image
  const Eigen::MatrixXd k = stiffness_matrix(net);
  const auto blocks = diagonal_blocks(net);
  const Eigen::Index d = net.dofs_per_grain();
  for (std::size_t g = 0; g < net.size(); ++g) {
    const Eigen::Map<const Eigen::MatrixXd> block(&blocks[g * static_cast<std::size_t>(d * d)], d, d);
    const auto at = static_cast<Eigen::Index>(g) * d;
    EXPECT_LE((block - k.block(at, at, d, d)).norm(), 1e-13 * k.norm());
  }
}

TEST_P(Solve, BlockJacobiInvertsTheBlocks) {
  const Network net = network();
  const auto blocks = diagonal_blocks(net);
  const Eigen::Index d = net.dofs_per_grain();
  const BlockJacobi jacobi(blocks, static_cast<int>(d));
  const auto r = random_unit_vector(total_dofs(net), 3);
  std::vector<double> z(r.size());
  jacobi.apply(r, z);
  for (std::size_t g = 0; g < net.size(); ++g) {
    const Eigen::Map<const Eigen::MatrixXd> block(&blocks[g * static_cast<std::size_t>(d * d)], d, d);
    if (block.fullPivLu().rank() < d) continue;
    const auto at = static_cast<Eigen::Index>(g) * d;
    const Eigen::VectorXd in = vector_of(r).segment(at, d), out = vector_of(z).segment(at, d);
    EXPECT_LE((block * out - in).norm(), 1e-5 * in.norm());
  }
}

TEST_P(Solve, FindsTheMinimumAndKnowsItsError) {
  const Network net = network();
  const StiffnessOperator k(net, StiffnessOperator::Scaling::none);
  const BlockJacobi jacobi(diagonal_blocks(net), net.dofs_per_grain());
  const auto some = random_unit_vector(k.rows(), 5);
  std::vector<double> b(k.rows()), x(k.rows());
  k.apply(some, b);  // in the range of the singular K
  const Eigen::MatrixXd dense = stiffness_matrix(net);
  const Eigen::VectorXd exact = dense.completeOrthogonalDecomposition().solve(vector_of(b));
  for (const double tolerance : {1e-3, 1e-6, 1e-10}) {
    const auto result = conjugate_gradient(k, jacobi, b, x, {tolerance});
    ASSERT_TRUE(result.converged);
    const Eigen::VectorXd miss = vector_of(x) - exact;
    const double error = miss.dot(dense * miss);
    EXPECT_NEAR(result.energy, vector_of(x).dot(dense * vector_of(x)), 1e-9 * result.energy);
    EXPECT_LE(error, 1.0 * result.error + 1e-20) << tolerance;
    EXPECT_LE(result.error, tolerance * result.energy);
  }
}

TEST_P(Solve, NothingToDoTakesNoIteration) {
  const Network net = network();
  const StiffnessOperator k(net, StiffnessOperator::Scaling::none);
  const BlockJacobi jacobi(diagonal_blocks(net), net.dofs_per_grain());
  const std::vector<double> b(k.rows(), 0.0);
  std::vector<double> x(k.rows(), 1.0);
  const auto result = conjugate_gradient(k, jacobi, b, x);
  EXPECT_TRUE(result.converged);
  EXPECT_EQ(result.iterations, 0);
  EXPECT_EQ(norm(x), 0);
}

INSTANTIATE_TEST_SUITE_P(All, Solve, testing::Values(Case{3, true}, Case{3, false}, Case{2, true}, Case{2, false}));

}  // namespace
}  // namespace eg
