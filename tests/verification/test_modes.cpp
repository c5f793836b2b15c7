// Modes and their density: a chain in closed form, crystals with eigenvalues that occur many times, random packings
// against the dense solver, and the time step.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "support/networks.hpp"
#include "timestep/interval.hpp"
#include "waves/density.hpp"

namespace eg {
namespace {

constexpr double pi = std::numbers::pi;

/// n unit masses in a row between two walls, springs k = 3 along it and nothing across.
Network fixed_chain(std::size_t n) {
  Network net;
  net.dimension = 2, net.rotation = false;
  for (std::size_t g = 0; g < n; ++g) {
    net.inverse_mass.push_back(1), net.radius.push_back(0.5), net.id.push_back(static_cast<Index>(g));
    if (g > 0) net.springs.push_back({static_cast<Index>(g - 1), static_cast<Index>(g), .5, .5, 3, 0, {1, 0, 0}, 1});
  }
  net.springs.push_back({0, no_index, .5, 0, 3, 0, {-1, 0, 0}, .5});
  net.springs.push_back({static_cast<Index>(n - 1), no_index, .5, 0, 3, 0, {1, 0, 0}, .5});
  return net;
}

double chain_frequency(std::size_t j, std::size_t n) {
  return 2 * std::sqrt(3.0) * std::sin(pi * static_cast<double>(j) / (2 * (static_cast<double>(n) + 1))) / (2 * pi);
}

TEST(Modes, FixedChain) {
  const std::size_t n = 60;
  const Network net = fixed_chain(n);
  const auto low = lowest_modes(net, 5), high = highest_modes(net, 5), all = all_modes(net, true);
  EXPECT_EQ(low.zero, n);  // across the chain nothing is stiff
  EXPECT_EQ(all.zero, n);
  ASSERT_EQ(all.modes.size(), n);
  for (std::size_t j = 1; j <= n; ++j) EXPECT_NEAR(all.modes[j - 1].frequency(), chain_frequency(j, n), 1e-9);
  for (std::size_t j = 1; j <= 5; ++j) {
    EXPECT_NEAR(low.modes[j - 1].frequency(), chain_frequency(j, n), 1e-9);
    EXPECT_NEAR(high.modes[j - 1].frequency(), chain_frequency(n - 5 + j, n), 1e-9);
  }
  // A standing wave: shares 2 sin²/(n + 1), so 1/(n Σ p²) = 2(n + 1)/(3n).
  EXPECT_NEAR(low.modes[0].participation, 2.0 * (n + 1) / (3.0 * n), 1e-9);
  const auto window = modes_between(net, 0.2, 0.3);
  std::size_t expected = 0;
  for (std::size_t j = 1; j <= n; ++j) expected += chain_frequency(j, n) >= 0.2 && chain_frequency(j, n) < 0.3;
  EXPECT_EQ(window.modes.size(), expected);
  EXPECT_EQ(window.complete, true);
}

TEST(Modes, ManyfoldModesOfACrystal) {
  const Network net = test::lattice_network("fcc", 3, 1.0, 1.0, true);
  const auto all = all_modes(net, false);
  const auto low = lowest_modes(net, 40), high = highest_modes(net, 20);
  EXPECT_EQ(low.complete, true);
  EXPECT_EQ(high.complete, true);
  EXPECT_EQ(low.zero, 3u);
  ASSERT_EQ(low.modes.size(), 40u);
  for (std::size_t k = 0; k < 40; ++k) EXPECT_NEAR(low.modes[k].square, all.modes[k].square, 1e-9 * 40);
  EXPECT_NEAR(high.modes.back().square, 40, 1e-9);
  EXPECT_NEAR(high.modes.back().rotation, 1, 1e-9);
  EXPECT_NEAR(high.modes.back().participation, 1, 1e-6);
}

TEST(Modes, RandomPackingAgainstDense) {
  for (const int dimension : {2, 3}) {
    const Network net =
        test::random_network({.dimension = dimension, .grains = 120, .tangential_ratio = -1, .fixed_share = 0.05}, 7);
    const auto all = all_modes(net, true);
    const auto low = lowest_modes(net, 12), high = highest_modes(net, 12);
    EXPECT_EQ(low.zero, all.zero);
    EXPECT_EQ(low.total, all.modes.size() + *all.zero);
    const double scale = all.modes.back().square;
    for (std::size_t k = 0; k < 12; ++k) {
      EXPECT_NEAR(low.modes[k].square, all.modes[k].square, 1e-8 * scale);
      EXPECT_LT(low.modes[k].residual, 1e-7 * scale);
      EXPECT_NEAR(high.modes[k].square, all.modes[all.modes.size() - 12 + k].square, 1e-9 * scale);
    }
    const double from = all.modes[40].frequency() * 1.0001, to = all.modes[90].frequency() * 1.0001;
    const auto window = modes_between(net, from, to);
    const auto inside =
        std::ranges::count_if(all.modes, [&](const Mode& m) { return m.frequency() >= from && m.frequency() < to; });
    EXPECT_EQ(static_cast<std::ptrdiff_t>(window.modes.size()), inside);
    const auto interval = step_interval(net);
    EXPECT_LE(high.modes.back().square, interval.lambda_upper);
    EXPECT_GE(high.modes.back().square, interval.lambda_lower * (1 - 1e-12));
  }
}

TEST(Density, KernelPolynomialAgainstAllModes) {
  const Network net = test::random_network({.grains = 200, .size_ratio = 2, .tangential_ratio = -1}, 3);
  const auto exact = dense_density(all_modes(net, false), 20);
  const auto kernel = kernel_density(net, 20, {.vectors = 250});
  EXPECT_EQ(exact.total, 1200);
  EXPECT_NEAR(std::accumulate(exact.modes.begin(), exact.modes.end(), 0.0), 1200, 1e-9);
  EXPECT_NEAR(std::accumulate(kernel.modes.begin(), kernel.modes.end(), 0.0), 1200, 1e-6);
  EXPECT_NEAR(kernel.highest, exact.highest, 1e-6 * exact.highest);
  EXPECT_LT(kernel.error, 6e-3);
  double below = 0, deviation = 0, spread = 0;
  for (std::size_t k = 0; k < 20; ++k) {
    below += kernel.modes[k] - exact.modes[k];
    deviation = std::max(deviation, std::abs(below));
    spread += std::abs(kernel.modes[k] - exact.modes[k]);
  }
  EXPECT_LT(deviation, 0.01 * exact.total);
  EXPECT_LT(spread, 0.03 * exact.total);  // of 20 intervals, in a packing of few modes
}

}  // namespace
}  // namespace eg
