// Never wrong: 2,000 random and adversarial networks whose largest eigenvalue is known from the whole spectrum. No
// interval excludes it, and no certificate accepts a number below it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <numeric>

#include "../support/networks.hpp"
#include "assembly/stiffness.hpp"
#include "eigen/dense.hpp"
#include "timestep/collatz.hpp"
#include "timestep/incomplete_cholesky.hpp"
#include "timestep/interval.hpp"
#include "timestep/patch.hpp"
#include "timestep/random_test.hpp"
#include "timestep/scalar_weights.hpp"
#include "timestep/sparse_certificate.hpp"

namespace eg {
namespace {

Vec3 direction(Random& random, int dimension) {
  Vec3 n{random.normal(), random.normal(), dimension == 3 ? random.normal() : 0.0};
  return n * (1 / norm(n));
}

Network grains(Random& random, int dimension, bool rotation, std::size_t count, double decades) {
  Network network;
  network.dimension = dimension;
  network.rotation = rotation;
  for (std::size_t g = 0; g < count; ++g) {
    const double m = std::pow(10, random.uniform(-decades, decades));
    network.inverse_mass.push_back(1 / m);
    if (rotation) network.inverse_inertia.push_back(1 / (0.4 * m * 0.25));
    network.radius.push_back(0.5);
    network.id.push_back(static_cast<Index>(g));
  }
  return network;
}

/// Stiffness over `decades` powers of ten, kt/kn up to 10.
Spring spring(Random& random, int dimension, std::size_t i, std::size_t j, double decades) {
  const double kn = std::pow(10, random.uniform(-decades, decades));
  const double ratio = random.uniform() < .2 ? 0 : std::pow(10, random.uniform(-3, 1));
  return {static_cast<Index>(i), static_cast<Index>(j), .5, .5, kn, ratio * kn, direction(random, dimension)};
}

Network ring(Random& random, int dimension, bool rotation) {  // odd ones frustrate every splitting
  const std::size_t count = 3 + random.below(9);
  Network network = grains(random, dimension, rotation, count, random.uniform() < .5 ? 0 : 2);
  for (std::size_t g = 0; g < count; ++g) network.springs.push_back(spring(random, dimension, g, (g + 1) % count, 0));
  return network;
}

Network clique(Random& random, int dimension, bool rotation) {
  const std::size_t count = 3 + random.below(5);
  Network network = grains(random, dimension, rotation, count, 0);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = i + 1; j < count; ++j) network.springs.push_back(spring(random, dimension, i, j, 0));
  return network;
}

Network chain(Random& random, int dimension, bool rotation) {  // between plates, stiffness and mass over decades
  const std::size_t count = 2 + random.below(12);
  Network network = grains(random, dimension, rotation, count, 2);
  for (std::size_t g = 0; g + 1 < count; ++g) network.springs.push_back(spring(random, dimension, g, g + 1, 3));
  Spring wall = spring(random, dimension, 0, 0, 3);
  wall.j = no_index, wall.arm_j = 0;
  network.springs.push_back(wall);
  return network;
}

/// Two copies of one cluster, the second changed in the twelfth digit: the top is nearly double.
Network twins(Random& random, std::uint64_t seed) {
  Network network = test::random_network({.grains = 5 + random.below(6), .wall_share = 0}, seed);
  const auto size = static_cast<Index>(network.size());
  const Network one = network;
  for (Index g = 0; g < size; ++g) {
    network.inverse_mass.push_back(one.inverse_mass[g] * (1 + 1e-12 * random.uniform()));
    network.inverse_inertia.push_back(one.inverse_inertia[g]);
    network.radius.push_back(one.radius[g]);
    network.id.push_back(size + g);
  }
  for (Spring s : one.springs) {
    s.i += size, s.j += size;
    network.springs.push_back(s);
  }
  return network;
}

/// A lattice with a vacancy's stiffness change, a light interstitial, or springs scattered by some per cent.
Network crystal(Random& random, bool rotation) {
  const char* names[] = {"square", "hexagonal", "sc", "fcc"};
  const std::size_t which = random.below(4);
  Network network = test::lattice_network(names[which], which < 2 ? 3 : 2, 1, random.uniform(), rotation);
  for (auto& s : network.springs) s.normal *= 1 + .05 * random.normal(), s.tangential *= 1 + .05 * random.uniform();
  const std::size_t odd = random.below(network.size());
  const double light = std::pow(10, random.uniform(-1, 4));
  network.inverse_mass[odd] *= light;
  if (rotation) network.inverse_inertia[odd] *= light;
  return network;
}

Network sizes_apart(Random& random, int dimension, bool rotation, std::uint64_t seed) {
  return test::random_network({.dimension = dimension,
                               .rotation = rotation,
                               .grains = 3 + random.below(12),
                               .size_ratio = 100,
                               .tangential_ratio = -1,
                               .wall_share = .4,
                               .fixed_share = .15,
                               .crowding = 2},
                              seed);
}

Network adversary(std::uint64_t seed) {
  Random random(seed);
  const int dimension = seed % 3 == 0 ? 2 : 3;
  const bool rotation = random.uniform() < .8;
  switch (seed % 7) {
    case 0:
      return ring(random, dimension, rotation);
    case 1:
      return clique(random, dimension, rotation);
    case 2:
      return chain(random, dimension, rotation);
    case 3:
      return twins(random, seed);
    case 4:
      return crystal(random, rotation);
    case 5:
      return sizes_apart(random, dimension, rotation, seed);
    default:
      return test::random_network({.dimension = dimension, .rotation = rotation, .grains = 3 + random.below(16)}, seed);
  }
}

std::vector<Index> all_of(const Sides& sides) {
  std::vector<Index> all(sides.size());
  std::iota(all.begin(), all.end(), Index{0});
  return all;
}

/// σ below λmax by 1e-12 … 1e-1 of it: every certificate must refuse.
void refuses(const Network& network, double lambda, std::uint64_t seed) {
  Random random(seed);
  const double sigma = lambda * (1 - std::pow(10, random.uniform(-12, -1)));
  const Sides sides(network);
  const ScalarWeights scalars = sweep_scalars(sides, {});
  WeightedContacts contacts(sides, {scalars.t, {}, {}});
  BlockRanges ranges = scalars.ranges;
  contacts.make_matrices(ranges.low, .5);
  for (int k = 0; k < 3; ++k) contacts.sweep(4);
  contacts.update(ranges);
  EXPECT_GE(contacts.bound(ranges).value, lambda * (1 - 1e-13)) << seed;
  for (const double drop : {1e-4, 1e-2, 1.}) {
    EXPECT_FALSE(factorise_below(contacts, stiff_patch(sides, ranges, sigma, 1), sigma, drop).below) << seed;
    for (const double least : {.9, .98})
      EXPECT_FALSE(factorise_below(contacts, stiff_patch(contacts, ranges, sigma, {1, least}), sigma, drop).below)
          << seed;
  }
  EXPECT_FALSE(factorise_below(contacts, all_of(sides), sigma, 1e-3).below) << seed;
  EXPECT_FALSE(sparse_cholesky_below(network, sigma)) << seed;
  EXPECT_GE(collatz_bound(network).value, lambda * (1 - 1e-13)) << seed;
  EXPECT_FALSE(random_test(network, .99 * sigma, sigma, seed).below) << seed;
}

TEST(NeverWrong, TwoThousandRandomAndAdversarialNetworks) {
  int cases = 0;
  std::vector<double> widths;
  for (std::uint64_t seed = 1; cases < 2000; ++seed) {
    const Network network = adversary(seed);
    if (network.springs.empty()) continue;
    const double lambda = dense_largest(dense_scaled_stiffness(network)).value;
    if (lambda == 0) continue;
    ++cases;
    const double error = dense_relative_error(total_dofs(network)) * lambda;
    for (const std::size_t limit : {std::size_t{0}, std::size_t{600}}) {
      const auto interval = step_interval(network, {.dense_limit = limit});
      EXPECT_LE(interval.lambda_lower, lambda + error) << seed;
      EXPECT_TRUE(interval.probable_error == 0 || interval.lambda_probable >= lambda - error) << seed;
      EXPECT_GE(interval.lambda_upper, lambda - error) << seed;
      if (limit == 0) widths.push_back(interval.lambda_upper / interval.lambda_lower - 1);
    }
    refuses(network, lambda, seed);
  }
  std::sort(widths.begin(), widths.end());
  std::printf("%d cases; width in λ: median %.1e, 95 %% %.1e, worst %.1e\n", cases, widths[widths.size() / 2],
              widths[widths.size() * 95 / 100], widths.back());
}

TEST(NeverWrong, SparseCholeskyAcceptsWhatIsAbove) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const Network network = adversary(7 * seed + 6);
    const double lambda = dense_largest(dense_scaled_stiffness(network)).value;
    EXPECT_TRUE(sparse_cholesky_below(network, lambda * (1 + 1e-9))) << seed;
  }
}

}  // namespace
}  // namespace eg
