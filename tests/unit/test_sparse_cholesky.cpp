// The sparse Cholesky factorisation says what is positive definite, and solves.
#include <gtest/gtest.h>

#include "../support/networks.hpp"
#include "assembly/stiffness.hpp"
#include "eigen/dense.hpp"
#include "eigen/sparse_cholesky.hpp"

namespace eg {
namespace {

/// σ − M^−½KM^−½
Eigen::SparseMatrix<double> below(const Network& network, double sigma) {
  Eigen::SparseMatrix<double> a = stiffness_matrix(network);
  const auto inverse = inverse_mass_diagonal(network);
  const Eigen::VectorXd d = Eigen::Map<const Eigen::VectorXd>(inverse.data(), a.rows()).cwiseSqrt();
  a = -(d.asDiagonal() * a * d.asDiagonal()).eval();
  for (int k = 0; k < a.rows(); ++k) a.coeffRef(k, k) += sigma;
  a.makeCompressed();
  return a;
}

TEST(SparseCholesky, TellsPositiveDefiniteFromNot) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const auto network =
        test::random_network({.dimension = seed % 3 ? 3 : 2, .rotation = seed % 5 != 0, .grains = 30}, seed);
    const double lambda = dense_largest(dense_scaled_stiffness(network)).value;
    SparseCholesky cholesky(network.dofs_per_grain());
    EXPECT_TRUE(cholesky.factorise(below(network, lambda * (1 + 1e-9)))) << seed;
    EXPECT_FALSE(cholesky.factorise(below(network, lambda * (1 - 1e-9)))) << seed;
    EXPECT_TRUE(cholesky.factorise(below(network, 2 * lambda))) << seed;  // again after a failure
  }
}

TEST(SparseCholesky, Solves) {
  const auto network = test::random_network({.grains = 200}, 3);
  Eigen::SparseMatrix<double> a = stiffness_matrix(network);
  for (int k = 0; k < a.rows(); ++k) a.coeffRef(k, k) += 1;
  SparseCholesky cholesky(network.dofs_per_grain());
  ASSERT_TRUE(cholesky.factorise(a));
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(a.rows(), -1, 2);
  Eigen::VectorXd b = a * x;
  const auto size = static_cast<std::size_t>(b.size());
  cholesky.solve(std::span(b.data(), size), std::span(b.data(), size));
  EXPECT_LE((b - x).norm(), 1e-10 * x.norm());
  EXPECT_GT(cholesky.factor_entries(), static_cast<std::size_t>(a.nonZeros()) / 2);
}

TEST(SparseCholesky, TakesAnotherPatternAndMoves) {
  SparseCholesky cholesky(6);
  for (std::uint64_t seed = 1; seed <= 5; ++seed)
    EXPECT_TRUE(cholesky.factorise(below(test::random_network({.grains = 10 + seed}, seed), 1e6)));
  SparseCholesky other = std::move(cholesky);
  EXPECT_FALSE(other.factorise(below(test::random_network({.grains = 12}, 2), 1e-6)));
}

TEST(SparseCholesky, RefusesWhatIsNotANumber) {
  Eigen::SparseMatrix<double> a(2, 2);
  a.insert(0, 0) = 1, a.insert(1, 1) = NAN;
  a.makeCompressed();
  EXPECT_FALSE(SparseCholesky().factorise(a));
}

TEST(SparseCholesky, MarginCoversTheRoundOffOfADenseFactorisation) {
  const auto network = test::random_network({.grains = 40, .crowding = 3}, 8);
  const double lambda = dense_largest(dense_scaled_stiffness(network)).value;
  const Eigen::SparseMatrix<double> a = below(network, lambda);
  const double margin = cholesky_margin(a);
  EXPECT_GT(margin, 0);
  EXPECT_LT(margin, 1e-8 * lambda);
  EXPECT_FALSE(SparseCholesky(6).factorise(below(network, lambda - margin)));
}

}  // namespace
}  // namespace eg
