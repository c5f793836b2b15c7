// The interval of the critical step: exact lattices, small and odd networks, and the limit found by stepping.
#include <gtest/gtest.h>

#include "../support/networks.hpp"
#include "assembly/stiffness.hpp"
#include "eigen/dense.hpp"
#include "timestep/estimates.hpp"
#include "timestep/interval.hpp"
#include "timestep/verify.hpp"

namespace eg {
namespace {

using test::lattice_network;
using test::random_network;

struct Lattice {
  const char* name;
  int cells;  ///< commensurate with the mode at the limit
  bool rotation;
  double lambda;   ///< kn = kt = m = 1
  double element;  ///< equal-share element bound
};

class Lattices : public testing::TestWithParam<Lattice> {};

TEST_P(Lattices, LimitOfTheInfiniteLattice) {
  const auto& l = GetParam();
  const auto network = lattice_network(l.name, l.cells, 1, 1, l.rotation);
  const double limit = 2 / std::sqrt(l.lambda);
  const auto interval = step_interval(network, {.dense_limit = 0});
  EXPECT_NEAR(interval.dt_limit_upper / limit, 1, 1e-8);
  EXPECT_LE(interval.dt_safe, limit);
  EXPECT_GE(interval.dt_safe, limit * (l.rotation ? 1 - 1e-8 : 0.8));
  EXPECT_NEAR(element_time_step(network), l.element, 1e-4);
}

INSTANTIATE_TEST_SUITE_P(EqualSprings, Lattices,
                         testing::Values(Lattice{"fcc", 4, true, 40, .2182}, Lattice{"fcc", 4, false, 16, .4082},
                                         Lattice{"bcc", 4, true, 80. / 3, .2673}, Lattice{"bcc", 4, false, 16, .5},
                                         Lattice{"sc", 4, true, 20, .3086}, Lattice{"sc", 4, false, 12, .5774},
                                         Lattice{"hexagonal", 6, true, 24, .3333},
                                         Lattice{"hexagonal", 6, false, 9, .5774},
                                         Lattice{"square", 4, true, 16, .4082}, Lattice{"square", 4, false, 8, .7071}));

TEST(Lattices, ClosedFormsForOtherRatiosOfStiffness) {
  for (const double kt : {0., .2, .35, .7, .86, 1.}) {
    const double kn = 1;
    const auto check = [&](const char* name, double t, double r) {
      const auto interval = step_interval(lattice_network(name, 4, kn, kt, true), {.dense_limit = 0});
      EXPECT_NEAR(interval.lambda_lower / std::max(t, r), 1, 2e-8) << name << " kt = " << kt;
      EXPECT_GE(interval.lambda_upper, std::max(t, r)) << name << " kt = " << kt;
    };
    check("fcc", 8 * (kn + kt), 40 * kt);
    check("sc", 4 * kn + 8 * kt, 20 * kt);
    check("bcc", 16. / 3 * (kn + 2 * kt), 80. / 3 * kt);
    check("square", 4 * kn + 4 * kt, 16 * kt);
  }
}

TEST(Interval, BracketsTheDenseValueWithoutTheDenseSolver) {
  std::vector<double> widths;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    Random random(seed);
    const auto network = random_network({.dimension = seed % 3 ? 3 : 2,
                                         .rotation = seed % 5 != 0,
                                         .grains = 4 + random.below(20),
                                         .size_ratio = random.uniform(1, 20),
                                         .tangential_ratio = -1,
                                         .fixed_share = seed % 2 ? .1 : 0},
                                        seed + 5000);
    if (network.springs.empty()) continue;
    const double lambda = dense_largest(dense_scaled_stiffness(network)).value;
    if (lambda == 0) continue;
    const auto interval = step_interval(network, {.dense_limit = 0});
    EXPECT_LE(interval.lambda_lower, lambda) << seed;
    EXPECT_GE(interval.lambda_upper, lambda) << seed;
    EXPECT_NEAR(interval.lambda_lower / lambda, 1, 1e-8) << seed;
    EXPECT_LE(interval.dt_safe, interval.dt_limit_upper);
    widths.push_back(interval.dt_limit_upper / interval.dt_safe - 1);
  }
  std::sort(widths.begin(), widths.end());
  std::printf("width of the step interval: median %.4f, worst %.4f\n", widths[widths.size() / 2], widths.back());
  EXPECT_LE(widths[widths.size() / 2], 0.01);
}

TEST(Interval, DenseAndIterativeAgree) {
  const auto network = random_network({.grains = 80}, 21);
  const auto dense = step_interval(network), iterative = step_interval(network, {.dense_limit = 0});
  EXPECT_EQ(dense.method_upper, "dense");
  EXPECT_NE(iterative.method_upper, "dense");
  EXPECT_LE(dense.dt_limit_upper / dense.dt_safe, 1 + 1e-11);
  EXPECT_NEAR(iterative.lambda_lower / dense.lambda_lower, 1, 1e-8);
  EXPECT_EQ(iterative.grain, dense.grain);
  EXPECT_NEAR(iterative.participation, dense.participation, 1e-4);
  EXPECT_NEAR(iterative.grain_share, dense.grain_share, 1e-4);
}

TEST(Interval, NothingStiff) {
  Network network;
  network.inverse_mass = {1, 2};
  network.inverse_inertia = {1, 2};
  network.radius = {1, 1};
  for (const bool fixed : {false, true}) {
    if (fixed) {
      network.inverse_mass = network.inverse_inertia = {0, 0};
      network.springs = {{0, 1, 1, 1, 5, 5, {1, 0, 0}}};
    }
    for (const std::size_t limit : {0, 600}) {
      const auto interval = step_interval(network, {.dense_limit = limit});
      EXPECT_EQ(interval.lambda_upper, 0);
      EXPECT_TRUE(std::isinf(interval.dt_safe) && interval.dt_safe > 0);
      EXPECT_EQ(interval.grain, no_index);
    }
  }
  EXPECT_TRUE(std::isinf(step_interval(Network{}).dt_safe));
}

TEST(Interval, OneGrainOnAWallAndARattler) {
  Network network;
  network.inverse_mass = {1 / 2., 1};
  network.inverse_inertia = {1 / 5., 1};
  network.radius = {1, 1};
  network.springs = {{0, no_index, 1, 0, 8, 0, {0, 0, -1}}};
  for (const std::size_t limit : {0, 600}) {
    const auto interval = step_interval(network, {.dense_limit = limit});
    EXPECT_NEAR(interval.dt_safe, 2 / std::sqrt(4.), 1e-11);
    EXPECT_NEAR(interval.dt_limit_upper, 1, 1e-11);
    EXPECT_EQ(interval.grain, 0u);
    EXPECT_EQ(interval.coordination, 1);
    EXPECT_NEAR(interval.participation, 1, 1e-12);
  }
}

TEST(Verify, SteppingFindsTheLimit) {
  const auto check = [](const Network& network, const std::string& name) {
    const auto interval = step_interval(network);
    const double limit = interval.dt_limit_upper;
    for (const double guess : {1.0, 0.8, 1.3}) {
      const auto bracket = verify_by_stepping(network, {.guess = guess * limit});
      EXPECT_NEAR(bracket.stable / limit, 1, 1e-3) << name << guess;
      EXPECT_NEAR(bracket.unstable / limit, 1, 1e-3) << name << guess;
      EXPECT_LT(bracket.stable, bracket.unstable);
    }
  };
  for (const char* name : {"fcc", "sc", "square"}) check(lattice_network(name, 2, 1, .8, true), name);
  for (std::uint64_t seed = 1; seed <= 3; ++seed)
    check(random_network({.grains = 40, .fixed_share = .1}, seed), "random");
}

TEST(Verify, RefusesWhatCannotVibrate) {
  EXPECT_THROW(verify_by_stepping(random_network({}, 1), {}), std::invalid_argument);
  Network still;
  still.inverse_mass = still.inverse_inertia = {0};
  still.radius = {1};
  EXPECT_THROW(verify_by_stepping(still, {.guess = 1}), std::invalid_argument);
}

}  // namespace
}  // namespace eg
