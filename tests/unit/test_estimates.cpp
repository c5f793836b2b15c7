// Rules of thumb: their numbers by hand, and what the exact limit says of them.
#include <gtest/gtest.h>

#include <map>
#include <numbers>

#include "../support/networks.hpp"
#include "timestep/estimates.hpp"
#include "timestep/interval.hpp"

namespace eg {
namespace {

std::map<std::string, double> by_name(const std::vector<Estimate>& rows) {
  std::map<std::string, double> steps;
  for (const auto& row : rows) steps[row.name] = row.dt;
  return steps;
}

/// Two equal frictionless spheres, m = kn = 1, with n along a space diagonal.
Network two_spheres() {
  Network network;
  network.rotation = false;
  network.inverse_mass = {1, 1};
  network.radius = {.5, .5};
  const double c = 1 / std::sqrt(3.0);
  network.springs = {{0, 1, .5, .5, 1, 0, {c, c, c}}};
  return network;
}

TEST(Estimates, DiagonalFormulasAreNotSafe) {
  const auto steps = by_name(time_step_estimates(two_spheres()));
  EXPECT_NEAR(steps.at("yade"), 1.960, 5e-4);
  EXPECT_NEAR(steps.at("itasca"), std::sqrt(3.0), 1e-12);
  EXPECT_NEAR(steps.at("element"), std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(step_interval(two_spheres()).dt_limit_upper, std::sqrt(2.0), 1e-12);
}

TEST(Estimates, StiffnessRulesByHand) {
  auto network = two_spheres();
  network.rotation = true;
  network.inverse_inertia = {10, 10};
  network.inverse_mass = {1, .25};
  network.springs[0].normal = 4;
  network.springs[0].tangential = 2;
  network.springs[0].n = {1, 0, 0};
  const auto steps = by_name(time_step_estimates(network));
  EXPECT_NEAR(steps.at("single-dof-min"), 1, 1e-14);
  EXPECT_NEAR(steps.at("single-dof-mean"), 2 * std::sqrt(2.5 / 4), 1e-14);
  EXPECT_NEAR(steps.at("cundall-strack"), 0.1 * std::sqrt(2.0) * .5, 1e-14);
  EXPECT_NEAR(steps.at("tsuji-min"), std::numbers::pi / 10, 1e-14);
  EXPECT_NEAR(steps.at("tu-andrade"), 1.2 * std::sqrt(.5), 1e-14);
  EXPECT_NEAR(steps.at("itasca"), std::sqrt(.1 / (2 * .25)), 1e-14);  // turning about y: kt a² against I
  EXPECT_EQ(steps.count("rayleigh-rmin"), 0u);
}

TEST(Estimates, WaveRulesByHand) {
  auto network = two_spheres();
  network.radius = {1e-3, 3e-3};
  const EstimateMaterial quartz{29e9, .12, 2650, 1.0};
  const auto steps = by_name(time_step_estimates(network, quartz));
  const double rayleigh = std::numbers::pi * 1e-3 * std::sqrt(2650 / 29e9) / (.1631 * .12 + .8766);
  EXPECT_NEAR(steps.at("rayleigh-rmin") / rayleigh, 1, 1e-14);
  EXPECT_NEAR(steps.at("rayleigh-rmean") / rayleigh, 2, 1e-14);
  EXPECT_NEAR(steps.at("p-wave-rmin"), 1e-3 * std::sqrt(2650 / (2.24 * 29e9)), 1e-20);
  EXPECT_EQ(by_name(time_step_estimates(network, {29e9, .12, 2650, {}})).count("hertz-time-rmin"), 0u);

  // Steel spheres at 1 m/s: the rule is the duration of a Hertz collision, 2.943275 δmax/v = 2.9879379e-6 s.
  network.radius = {.496e-3, .496e-3};
  const auto hertz = by_name(time_step_estimates(network, {80e9, .3, 7800, 1.0})).at("hertz-time-rmin");
  EXPECT_NEAR(hertz / 2.9879379e-6, 1, 2e-3);
}

TEST(Estimates, HertzMindlinFccAgainstRayleigh) {
  // kn = 2E*a, kt = 8G*a with a = √(R*δ): Δt/T_Rayleigh = c(ν)(δ/2R)^(−1/4), here ν = 0.12, δ/2R = 1e-4.
  const double g = 29e9, nu = .12, rho = 2650, r = .5, delta = 1e-4;
  const double a = std::sqrt(.5 * r * delta), kn = 2 * g / (1 - nu) * a, kt = 4 * g / (2 - nu) * a;
  auto network = test::lattice_network("fcc", 2, kn, kt, true);
  const double m = rho * std::numbers::pi / 6;
  for (double& v : network.inverse_mass) v = 1 / m;
  for (double& v : network.inverse_inertia) v = 1 / (.4 * m * r * r);
  const double exact = step_interval(network).dt_limit_upper;
  const double rayleigh = by_name(time_step_estimates(network, {g, nu, rho, {}})).at("rayleigh-rmin");
  EXPECT_NEAR(exact / rayleigh * std::pow(delta, .25), .127, 5e-4);
}

TEST(Estimates, RigorousRowsAreBelowTheLimit) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const auto network = test::random_network({.tangential_ratio = -1}, seed);
    const double limit = step_interval(network).dt_limit_upper;
    for (const auto& row : time_step_estimates(network))
      EXPECT_TRUE(!row.rigorous || row.dt <= limit * (1 + 1e-12)) << row.name << seed;
  }
}

TEST(Estimates, EmptyNetworksGiveNoRows) {
  EXPECT_TRUE(time_step_estimates(Network{}).empty());
  auto network = two_spheres();
  network.inverse_mass = {0, 0};
  EXPECT_TRUE(time_step_estimates(network).empty());
}

TEST(Summary, CountsWallsAndImages) {
  auto network = two_spheres();
  network.springs.push_back({0, no_index, .5, 0, 3, 1, {0, 0, 1}});
  network.springs.push_back({1, 1, .5, .5, 2, 1, {0, 0, 1}});
  EXPECT_EQ(coordination_numbers(network), (std::vector<int>{2, 3}));
  const auto summary = summarise(network);
  EXPECT_EQ(summary.coordination_max, 3);
  EXPECT_DOUBLE_EQ(summary.coordination_mean, 2.5);
  EXPECT_DOUBLE_EQ(summary.normal_min, 1);
  EXPECT_DOUBLE_EQ(summary.normal_max, 3);
  EXPECT_DOUBLE_EQ(summary.normal_mean, 2);
}

}  // namespace
}  // namespace eg
