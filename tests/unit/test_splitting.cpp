// Upper bounds of λmax that must hold without exception: contact splitting, block Collatz–Wielandt, Gershgorin,
// elements.
#include <gtest/gtest.h>

#include "../support/networks.hpp"
#include "assembly/stiffness.hpp"
#include "eigen/dense.hpp"
#include "timestep/collatz.hpp"
#include "timestep/splitting.hpp"

namespace eg {
namespace {

using test::lattice_network;
using test::random_network;

double exact(const Network& network) { return dense_largest(dense_scaled_stiffness(network)).value; }

TEST(Blocks, BoundsEncloseTheLargestEigenvalue) {
  Random random(3);
  for (int trial = 0; trial < 200; ++trial) {
    Eigen::Matrix<double, 6, 6> a;
    for (double& v : a.reshaped()) v = random.normal();
    const Block block = std::pow(10, random.uniform(-3, 16)) * a * a.transpose();
    const double bound = block_upper_bound(block, 6);
    const double value = dense_largest(block).value;
    EXPECT_GE(bound, value);
    EXPECT_LE(bound, value * (1 + 1e-12));
    EXPECT_TRUE(block_is_below(block, 6, value * (1 + 1e-11)));
    EXPECT_FALSE(block_is_below(block, 6, value * (1 - 1e-14)));
  }
}

TEST(Splitting, ExactOnLatticesOfEqualSpringsWithRotation) {
  for (const auto& [name, lambda] :
       {std::pair{"fcc", 40.}, {"bcc", 80. / 3}, {"sc", 20.}, {"hexagonal", 24.}, {"square", 16.}})
    EXPECT_NEAR(splitting_bound(lattice_network(name, 4, 1, 1, true), {.lower_bound = lambda}).value / lambda, 1, 1e-12)
        << name;
}

TEST(Splitting, TwoGrainsAreExactWithMatrixWeights) {
  // One contact: scalar weights meet the normal mode, matrices all three.
  Network network;
  network.inverse_mass = {1, 1 / 8.};
  network.inverse_inertia = {1 / .1, 1 / 3.2};
  network.radius = {.5, 1};
  network.springs = {{0, 1, .5, 1, 3, 2, {.6, .8, 0}}};
  EXPECT_NEAR(splitting_bound(network, {.close_enough = 0}).value / exact(network), 1, 1e-3);
}

TEST(Splitting, WarmStartKeepsTheBound) {
  const auto network = random_network({.grains = 60}, 11);
  SplittingWeights weights;
  const auto cold = splitting_bound(network, {}, &weights);
  const auto warm = splitting_bound(network, {.scalar_sweeps = 0, .matrix_sweeps = 0}, &weights);
  EXPECT_DOUBLE_EQ(warm.value, cold.value);
  EXPECT_EQ(warm.scalar_sweeps + warm.matrix_sweeps, 0);
  auto other = random_network({.grains = 50}, 12);
  EXPECT_GE(splitting_bound(other, {}, &weights).value, exact(other));  // weights of another network are dropped
}

TEST(Splitting, AnyWeightsAreAProof) {
  for (std::uint64_t seed = 1; seed < 200; ++seed) {
    const auto network = random_network({.tangential_ratio = -1}, seed);
    Random random(seed);
    SplittingWeights weights;
    for (std::size_t c = 0; c < network.springs.size(); ++c) {
      weights.scalar.push_back(std::exp(3 * random.normal()));
      if (random.uniform() < .5 && network.springs[c].j != no_index) {
        Eigen::Matrix3d m;
        for (double& v : m.reshaped()) v = std::pow(10, random.uniform(-1.5, 1.5)) * random.normal();
        const Eigen::Matrix3d t = m * m.transpose();  // now and then too near singular to be used
        weights.matrix_spring.push_back(static_cast<Index>(c));
        weights.matrix.push_back({t(0, 0), t(1, 1), t(2, 2), t(2, 1), t(2, 0), t(1, 0)});
      }
    }
    EXPECT_GE(splitting_bound(network, {.scalar_sweeps = 0, .matrix_sweeps = 0}, &weights).value, exact(network))
        << seed;
  }
}

TEST(Splitting, GrainsThatCannotMoveAndImagesOfThemselves) {
  Network network;
  network.inverse_mass = {1, 0, 0};
  network.inverse_inertia = {10, 0, 0};
  network.radius = {.5, .5, .5};
  network.springs = {{0, 1, .5, .5, 4, 1, {1, 0, 0}}, {1, 2, .5, .5, 1e9, 1, {1, 0, 0}}};
  EXPECT_NEAR(splitting_bound(network).value, 4, 1e-11);  // weight 1 towards a fixed grain, nothing between fixed ones
  network.springs = {{0, 0, .5, .5, 4, 2, {0, 0, 1}}};
  EXPECT_NEAR(splitting_bound(network).value, 2 * 1 * 10, 1e-11);
  network.springs.clear();
  EXPECT_EQ(splitting_bound(network).value, 0);
  EXPECT_EQ(collatz_bound(network).value, 0);
}

}  // namespace
}  // namespace eg
