// The robust incomplete factorisation never certifies a number below λmax, and the full one always one above it.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "../support/networks.hpp"
#include "eigen/dense.hpp"
#include "timestep/block_ranges.hpp"
#include "timestep/incomplete_cholesky.hpp"
#include "timestep/patch.hpp"

namespace eg {
namespace {

double exact(const Network& network) { return dense_largest(dense_scaled_stiffness(network)).value; }

std::vector<Index> all_of(const Sides& sides) {
  std::vector<Index> all(sides.size());
  std::iota(all.begin(), all.end(), Index{0});
  return all;
}

TEST(IncompleteCholesky, NeverCertifiesWhatIsBelowTheLargestEigenvalue) {
  int outside_fine = 0;
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    Random random(seed);
    const auto network = test::random_network({.dimension = seed % 3 == 0 ? 2 : 3,
                                               .rotation = seed % 5 != 0,
                                               .grains = 4 + random.below(16),
                                               .size_ratio = seed % 2 ? 3.0 : 30.0,
                                               .tangential_ratio = seed % 4 ? .8 : -1,
                                               .fixed_share = seed % 6 ? 0 : .2},
                                              seed);
    const double lambda = exact(network);
    if (lambda == 0) continue;
    const Sides sides(network);
    std::vector<double> t;
    for (std::size_t c = 0; c < network.springs.size(); ++c) t.push_back(std::exp(random.normal()));
    BlockRanges ranges(sides.size());
    block_ranges(sides, t, all_of(sides), ranges);
    const double sigma = lambda * (1 - std::pow(10, random.uniform(-12, -1)));
    // The grains that splitting leaves open, and some more in any order.
    std::vector<Index> patch;
    for (const Index g : all_of(sides))
      if (ranges.high[g] >= sigma || random.uniform() < .3) patch.push_back(g);
    outside_fine += patch.size() < sides.size();
    const WeightedContacts contacts(sides, {t, {}, {}});
    for (const double drop : {0., 1e-3, .1, 10.})
      EXPECT_FALSE(factorise_below(contacts, patch, sigma, drop).below) << seed << " drop " << drop;
  }
  EXPECT_GT(outside_fine, 300);  // else this has shown little
}

TEST(IncompleteCholesky, WithoutDropsCertifiesAllThatIsAbove) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const auto network = test::random_network({.grains = 20}, seed);
    const Sides sides(network);
    const std::vector<double> t(network.springs.size(), 1.0);
    const auto done =
        factorise_below(WeightedContacts(sides, {t, {}, {}}), all_of(sides), exact(network) * (1 + 1e-5), 0);
    EXPECT_TRUE(done.below) << seed;
    EXPECT_EQ(done.dropped, 0u);
  }
}

TEST(BlockRanges, EncloseTheLargestEigenvalueOfEveryBlock) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const auto network = test::random_network({.dimension = seed % 3 ? 3 : 2, .grains = 21, .size_ratio = 10}, seed);
    const Sides sides(network);
    Random random(seed);
    std::vector<double> t;
    for (std::size_t c = 0; c < network.springs.size(); ++c) t.push_back(std::exp(2 * random.normal()));
    BlockRanges ranges(sides.size());
    block_ranges(sides, t, all_of(sides), ranges);
    for (std::size_t g = 0; g < sides.size(); ++g) {
      const Block block = sides.block(g, [&](const Side& side) -> Eigen::Matrix3d {
        const double w = side.role == Side::Role::alone   ? 1
                         : side.role == Side::Role::first ? 1 + t[side.spring]
                                                          : 1 + 1 / t[side.spring];
        return w * contact_stiffness(network.springs[side.spring]);
      });
      const double value = sides.of(g).empty() ? 0 : dense_largest(block).value;
      EXPECT_GE(ranges.high[g], value);
      EXPECT_LE(ranges.low[g], value * (1 + 1e-12));
      EXPECT_LE(ranges.high[g], 1.12 * ranges.low[g]);
    }
  }
}

TEST(Patch, AloneIsAPrincipalPart) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const auto network = test::random_network({.grains = 20}, seed);
    const Sides sides(network);
    const std::vector<Index> some{3, 11, 4, 17, 8};
    const Eigen::MatrixXd whole = dense_scaled_stiffness(network),
                          part = dense_scaled_stiffness(patch_network(sides, some));
    for (std::size_t a = 0; a < some.size(); ++a)
      for (std::size_t b = 0; b < some.size(); ++b)
        EXPECT_LE(
            (part.block<6, 6>(Eigen::Index(6 * a), Eigen::Index(6 * b)) - whole.block<6, 6>(6 * some[a], 6 * some[b]))
                .norm(),
            1e-12 * whole.norm());
  }
}

}  // namespace
}  // namespace eg
