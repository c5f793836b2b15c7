// 1,000 random small networks (2D and 3D, with and without rotation, walls, fixed grains, kt/kn 0–1, size ratio to 20):
// every bound of λmax holds against the dense value, and every solver gives that value.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "../support/networks.hpp"
#include "assembly/apply.hpp"
#include "assembly/stiffness.hpp"
#include "eigen/arpack.hpp"
#include "eigen/dense.hpp"
#include "eigen/lanczos.hpp"
#include "timestep/collatz.hpp"
#include "timestep/estimates.hpp"
#include "timestep/interval.hpp"

namespace eg {
namespace {

Network any_network(std::uint64_t seed) {
  Random random(seed);
  test::RandomNetworkOptions o;
  o.dimension = seed % 3 == 0 ? 2 : 3;
  o.rotation = seed % 5 != 0;
  o.grains = 3 + random.below(18);
  o.size_ratio = std::exp(random.uniform() * std::log(20.0));
  o.tangential_ratio = seed % 4 == 0 ? -1 : random.uniform();
  if (seed % 7 == 0) o.tangential_ratio = 0;
  o.wall_share = seed % 2 ? .3 : 0;
  o.fixed_share = seed % 6 == 0 ? .2 : 0;
  return test::random_network(o, seed);
}

/// Median, 95 % and worst of a list of ratios.
void print(const char* name, std::vector<double> ratios) {
  std::sort(ratios.begin(), ratios.end());
  const auto at = [&](double share) { return ratios[static_cast<std::size_t>(share * double(ratios.size() - 1))]; };
  std::printf("%-40s median %.4f   95 %% %.4f   worst %.4f\n", name, at(.5), at(.95), at(1));
}

TEST(Bounds, HoldForAThousandSmallNetworks) {
  std::vector<double> splitting, collatz, width;
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    const auto network = any_network(seed);
    const double lambda = dense_largest(dense_scaled_stiffness(network)).value;
    if (lambda == 0) continue;
    const StiffnessOperator a(network, StiffnessOperator::Scaling::mass);
    ASSERT_NEAR(lanczos_largest(a).value / lambda, 1, 1e-8) << seed;
    ASSERT_NEAR(arpack_largest(a).value / lambda, 1, 1e-8) << seed;

    splitting.push_back(splitting_bound(network).value / lambda);
    collatz.push_back(collatz_bound(network).value / lambda);
    EXPECT_GE(splitting.back(), 1 - 1e-13) << seed;
    EXPECT_GE(collatz.back(), 1 - 1e-13) << seed;

    const double limit = 2 / std::sqrt(lambda);
    EXPECT_LE(element_time_step(network), limit * (1 + 1e-13)) << seed;
    EXPECT_LE(gershgorin_time_step(network), limit * (1 + 1e-13)) << seed;
    const auto interval = step_interval(network, {.dense_limit = 0});
    EXPECT_LE(interval.dt_safe, limit) << seed;
    EXPECT_GE(interval.dt_limit_upper, limit) << seed;
    width.push_back(interval.dt_limit_upper / interval.dt_safe);
  }
  ASSERT_GT(width.size(), 900u);
  print("splitting bound / exact λ", splitting);
  print("Collatz-Wielandt bound / exact λ", collatz);
  print("upper / lower end of the step interval", width);
  std::nth_element(width.begin(), width.begin() + width.size() / 2, width.end());
  EXPECT_LE(width[width.size() / 2], 1.0011);
}

}  // namespace
}  // namespace eg
