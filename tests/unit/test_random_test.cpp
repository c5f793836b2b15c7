#include <gtest/gtest.h>

#include "assembly/stiffness.hpp"
#include "eigen/dense.hpp"
#include "support/networks.hpp"
#include "support/packings.hpp"
#include "timestep/interval.hpp"
#include "timestep/random_test.hpp"

using namespace eg;

namespace {

TEST(RandomTest, TellsABoundFromWhatLiesAThousandthBelowTheEigenvalue) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const Network network = test::random_network({.grains = 20}, seed);
    const double lambda = dense_largest(dense_scaled_stiffness(network)).value;
    EXPECT_TRUE(random_test(network, lambda, 1.01 * lambda, seed).below) << seed;
    EXPECT_TRUE(random_test(network, (1 - 1e-4) * lambda, 1.01 * lambda, seed).below) << seed;
    EXPECT_FALSE(random_test(network, .99 * lambda, .999 * lambda, seed).below) << seed;
    EXPECT_FALSE(random_test(network, .5 * lambda, .6 * lambda, seed).below) << seed;
  }
}

TEST(RandomTest, GivesACrystalOfScatteredRadiiTheWidthThatNoProofReaches) {
  const Scene scene = test::lattice_scene("hertz-mindlin", "fcc", {10, 10, 10}, 0.01);
  const Network network = linearise(scene, test::scattered_lattice(scene, 0.002));
  const StepInterval interval = step_interval(network);
  const double lambda = step_interval(network, {.tolerance = 1e-9}).lambda_lower;
  ASSERT_GT(interval.probable_error, 0);
  EXPECT_LE(interval.probable_error, 1.01e-10);
  EXPECT_GE(interval.lambda_probable, lambda);
  EXPECT_LE(interval.lambda_probable, 1.0101 * interval.lambda_lower);
  EXPECT_GT(interval.lambda_upper, interval.lambda_probable);
  EXPECT_GT(interval.dt_probable, interval.dt_safe);
}

}  // namespace
