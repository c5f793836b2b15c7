// Eigensolvers against each other, on the operators they are meant for.
#include <gtest/gtest.h>

#include "../support/networks.hpp"
#include "assembly/apply.hpp"
#include "assembly/stiffness.hpp"
#include "eigen/arpack.hpp"
#include "eigen/dense.hpp"
#include "eigen/lanczos.hpp"

namespace eg {
namespace {

struct Diagonal {
  std::vector<double> d;
  std::size_t rows() const { return d.size(); }
  void apply(std::span<const double> x, std::span<double> y) const {
    for (std::size_t k = 0; k < d.size(); ++k) y[k] = d[k] * x[k];
  }
};
static_assert(LinearOperator<Diagonal> && LinearOperator<StiffnessOperator>);

TEST(Tridiagonal, TopOfTheSecondDifference) {
  const std::size_t n = 200;
  const auto top = tridiagonal_top(std::vector(n, 2.0), std::vector(n - 1, 1.0));
  EXPECT_NEAR(top.value, 2 + 2 * std::cos(M_PI / 201), 1e-14);
  for (std::size_t k = 0; k < n; ++k)
    EXPECT_NEAR(top.vector[k], std::sqrt(2.0 / 201) * std::sin(M_PI * (double(k) + 1) / 201), 1e-9);
}

TEST(Lanczos, DiagonalSpectrumAndItsVector) {
  Diagonal a;
  for (int k = 0; k < 5000; ++k) a.d.push_back(std::sqrt(k));
  a.d[1234] = 80;
  const auto result = lanczos_largest(a, {.tolerance = 1e-9});
  EXPECT_TRUE(result.converged);
  EXPECT_NEAR(result.value, 80, 1e-12);
  EXPECT_LE(result.residual, 1e-9 * 80);
  EXPECT_NEAR(std::abs(result.vector[1234]), 1, 1e-8);
}

TEST(Lanczos, ExhaustsSmallSpaces) {
  for (std::size_t n = 1; n < 12; ++n) {
    Diagonal a{std::vector(n, 1.0)};
    a.d[0] = 3;
    EXPECT_NEAR(lanczos_largest(a).value, 3, 1e-13) << n;
  }
  EXPECT_EQ(lanczos_largest(Diagonal{}).value, 0);
  EXPECT_EQ(lanczos_largest(Diagonal{std::vector(7, 0.0)}).value, 0);
}

TEST(Lanczos, NeverAboveTheLargestEigenvalueAndRepeatable) {
  for (std::uint64_t seed = 1; seed < 40; ++seed) {
    Diagonal a;
    Random random(seed);
    for (int k = 0; k < 300; ++k) a.d.push_back(random.uniform());
    const double largest = *std::max_element(a.d.begin(), a.d.end());
    const auto first = lanczos_largest(a, {.max_steps = 80, .max_restarts = 0, .seed = seed});
    EXPECT_LE(first.value, largest * (1 + 1e-13));
    EXPECT_EQ(first.value, lanczos_largest(a, {.max_steps = 80, .max_restarts = 0, .seed = seed}).value);
  }
}

TEST(Lanczos, TakesAStartVector) {
  Diagonal a{{1, 5, 2, 3}};
  const std::vector<double> start{0, 10, 0, 0};
  const auto result = lanczos_largest(a, {.start = start});
  EXPECT_DOUBLE_EQ(result.value, 5);
  EXPECT_LE(result.products, 3);
}

TEST(Solvers, AgreeOnNetworks) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const int dimension = seed % 2 ? 3 : 2;
    const auto network = test::random_network({.dimension = dimension, .rotation = seed % 3 != 0, .grains = 30}, seed);
    const StiffnessOperator a(network, StiffnessOperator::Scaling::mass);
    const auto dense = dense_largest(dense_scaled_stiffness(network));
    ASSERT_GT(dense.value, 0);
    EXPECT_NEAR(lanczos_largest(a).value / dense.value, 1, 1e-8) << seed;
    EXPECT_NEAR(arpack_largest(a).value / dense.value, 1, 1e-8) << seed;
    EXPECT_LE(dense.residual, 1e-12 * dense.value);
  }
}

}  // namespace
}  // namespace eg
