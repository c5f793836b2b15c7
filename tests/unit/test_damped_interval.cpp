// The damped limit against dense algebra: 4M − 2Δt C − Δt² K is positive definite below it and not above.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "assembly/stiffness.hpp"
#include "support/networks.hpp"
#include "timestep/damped_interval.hpp"
#include "timestep/splitting.hpp"

namespace eg {
namespace {

/// Least positive Δt at which 4 − 2Δt C − Δt² K is singular, K and C mass-scaled: an eigenvalue of the companion form
/// of the quadratic problem (K Δt² + 2C Δt − 4) x = 0.
double quadratic_limit(const Eigen::MatrixXd& k, const Eigen::MatrixXd& c) {
  const auto n = k.rows();  // with s = 1/Δt: (4s² − 2C s − K) x = 0
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  companion.topRightCorner(n, n).setIdentity();
  companion.bottomLeftCorner(n, n) = 0.25 * k;
  companion.bottomRightCorner(n, n) = 0.5 * c;
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(companion, false);
  double largest = 0;
  for (const auto& s : solver.eigenvalues()) largest = std::max(largest, s.real());
  return 1 / largest;
}

double exact_limit(const Network& network, const DampingSpec& damping) {
  const double force = 1 + damping.local;
  const Eigen::MatrixXd k = force * dense_scaled_stiffness(network);
  Eigen::MatrixXd c = force * dense_scaled_stiffness(dashpots(network, damping));
  const auto inverse = inverse_mass_diagonal(network);
  for (Eigen::Index i = 0; i < c.rows(); ++i)
    if (inverse[static_cast<std::size_t>(i)] > 0) c(i, i) += damping.mass;
  return quadratic_limit(k, c);
}

DampingSpec spec(double local, double mass, double normal, double shear) {
  DampingSpec d;
  d.local = local, d.mass = mass, d.normal_ratio = normal, d.shear_ratio = shear;
  return d;
}

const std::vector<DampingSpec>& specs() {
  static const std::vector<DampingSpec> all{spec(0, 0, 0, 0),     spec(0.7, 0, 0, 0),   spec(0, 3, 0, 0),
                                            spec(0, 0, 0.2, 0.2), spec(0, 0, 1, 0),     spec(0, 0, 3, 2),
                                            spec(0, 0.5, 0, 0.7), spec(0.3, 1, 0.5, 1), spec(0.9, 10, 20, 20)};
  return all;
}

TEST(DampedInterval, OneGrainOnAWallHasTheTextbookLimit) {
  Network net;
  net.rotation = false, net.inverse_mass = {0.5}, net.radius = {1}, net.id = {1};
  net.springs = {{0, no_index, 1, 0, 8, 0, {0, 0, 1}}};
  const double omega = 2;
  for (const double xi : {0.0, 0.1, 1.0, 5.0}) {
    const double limit = 2 / omega * (std::sqrt(1 + xi * xi) - xi);
    const auto v = damped_interval(net, spec(0, 0, xi, 0), step_interval(net));
    EXPECT_NEAR(v.dt_safe, limit, 1e-11 * limit) << xi;
    EXPECT_NEAR(v.dt_limit_upper, limit, 1e-11 * limit) << xi;
    const auto drag = damped_interval(net, spec(0, 2 * xi * omega, 0, 0), step_interval(net));
    EXPECT_NEAR(drag.dt_safe, limit, 1e-11 * limit) << xi;
  }
  const auto local = damped_interval(net, spec(0.7, 0, 0, 0), step_interval(net));
  EXPECT_NEAR(local.dt_safe, 2 / omega / std::sqrt(1.7), 1e-11);
}

TEST(DampedInterval, MassDampingAloneLimitsTheStep) {
  Network net;
  net.inverse_mass = {1}, net.inverse_inertia = {1}, net.radius = {1}, net.id = {1};
  EXPECT_NEAR(damped_interval(net, spec(0, 4, 0, 0), step_interval(net)).dt_safe, 0.5, 1e-12);
  EXPECT_TRUE(std::isinf(damped_interval(net, spec(0.5, 0, 1, 1), step_interval(net)).dt_safe));
}

TEST(DampedInterval, ContainsTheQuadraticEigenvalue) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    test::RandomNetworkOptions o;
    o.dimension = seed % 3 == 0 ? 2 : 3, o.rotation = seed % 4 != 0, o.grains = 20, o.fixed_share = 0.1;
    const Network net = test::random_network(o, seed);
    const StepInterval undamped = step_interval(net);
    for (const auto& d : specs()) {
      const double limit = exact_limit(net, d);
      const auto v = damped_interval(net, d, undamped);
      EXPECT_LE(v.dt_safe, limit * (1 + 1e-10)) << seed;
      EXPECT_GE(v.dt_limit_upper, limit * (1 - 1e-10)) << seed;
      EXPECT_LT(v.dt_limit_upper / v.dt_safe - 1, 1e-3) << seed;
      EXPECT_LE(v.rounds, 6);
    }
  }
}

TEST(DampedInterval, IterativeMethodsGiveTheSame) {
  const Network net = test::random_network({.grains = 40}, 5);
  const IntervalOptions iterative{.dense_limit = 0};
  for (const auto& d : specs()) {
    const double limit = exact_limit(net, d);
    const auto v = damped_interval(net, d, step_interval(net, iterative), iterative);
    EXPECT_LE(v.dt_safe, limit);
    EXPECT_GE(v.dt_limit_upper, limit * (1 - 1e-11));
    EXPECT_LT(v.dt_limit_upper / v.dt_safe - 1, 2e-2);
  }
}

TEST(DampedInterval, StepOfARunIsProvedAndNotWasteful) {
  const auto bound = [](const Network& n) { return splitting_bound(n, {.matrix_sweeps = 0}).value; };
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const Network net = test::random_network({.grains = 20}, seed);
    for (const auto& d : specs()) {
      const double limit = exact_limit(net, d);
      for (const double guess : {0.0, 0.7 * limit, 3 * limit, HUGE_VAL}) {
        const double safe = damped_safe_step(net, d, guess, bound);
        EXPECT_LE(safe, limit * (1 + 1e-10));
        EXPECT_GE(safe, 0.85 * limit) << seed << ' ' << guess / limit;
      }
    }
  }
}

TEST(DampedInterval, DashpotsAreThoseOfTheForceLoop) {
  const Network net = test::random_network({.grains = 20, .fixed_share = 0.2}, 3);
  const Network c = dashpots(net, spec(0, 0, 0.5, 0.25));
  for (std::size_t k = 0; k < net.springs.size(); ++k) {
    const Spring& s = net.springs[k];
    const double inverse = net.inverse_mass[s.i] + (s.j == no_index ? 0 : net.inverse_mass[s.j]);
    EXPECT_DOUBLE_EQ(c.springs[k].normal, inverse > 0 ? std::sqrt(s.normal / inverse) : 0);
    EXPECT_DOUBLE_EQ(c.springs[k].tangential, inverse > 0 ? 0.5 * std::sqrt(s.tangential / inverse) : 0);
  }
}

}  // namespace
}  // namespace eg
