// Spectra of nonsymmetric tangents: what eigenvalues mean, and the two ways of finding them.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <numbers>

#include "dynamics/engine.hpp"
#include "eigen/arpack_general.hpp"
#include "support/scenes.hpp"
#include "timestep/consistent.hpp"
#include "timestep/interval.hpp"

namespace eg {
namespace {

using Complex = std::complex<double>;

TEST(GeneralSpectrum, TellsFlutterFromCollapse) {
  // s² = −µ: µ = (2πf)² − g² ∓ 4πfg i grows at g with frequency f
  const double f = 3, g = 0.5, w = 2 * std::numbers::pi * f;
  const Complex pair = -std::pow(Complex(g, w), 2);
  const auto s =
      classify(std::vector<Complex>{{400, 0}, {-9, 0}, {-4, 0}, pair, std::conj(pair), {1e-9, 0}, {0, 1e-8}});
  EXPECT_EQ(s.flutter, 1u);
  EXPECT_NEAR(s.flutter_rate, g, 1e-12);
  EXPECT_NEAR(s.flutter_frequency, f, 1e-12);
  EXPECT_EQ(s.collapse, 2u);
  EXPECT_NEAR(s.collapse_rate, 3, 1e-12);
  EXPECT_EQ(s.largest_real, 400);
  EXPECT_NEAR(s.radius, 400, 1e-12);
}

TEST(GeneralSpectrum, ArpackFindsTheEndsOfABlockDiagonalMatrix) {
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(60, 60);
  for (int k = 0; k < 60; ++k) a(k, k) = k;
  a(20, 21) = 9, a(21, 20) = -9;  // 20.5 ± ~9i
  a(5, 5) = -7;
  const auto apply = [&](std::span<const double> x, std::span<double> y) {
    Eigen::Map<Eigen::VectorXd>(y.data(), 60) = a * Eigen::Map<const Eigen::VectorXd>(x.data(), 60);
  };
  const auto end = [&](SpectrumEnd e) { return arpack_general(60, apply, e, {.wanted = 4, .basis = 30}); };
  const auto has = [](const std::vector<Complex>& all, Complex z) {
    return std::ranges::any_of(all, [&](Complex v) { return std::abs(v - z) < 1e-7; });
  };
  EXPECT_TRUE(has(end(SpectrumEnd::largest_magnitude), 59.0));
  EXPECT_TRUE(has(end(SpectrumEnd::smallest_real), -7.0));
  EXPECT_TRUE(has(end(SpectrumEnd::largest_imaginary), Complex(20.5, std::sqrt(81 - 0.25))));
}

/// An overlapping cluster whose contacts carry shear forces: `mobilised` times Coulomb's limit.
State sheared(const Scene& scene, double mobilised) {
  State state = test::cluster(scene, 30, 4);
  { Engine lists(scene, state); }
  std::vector<std::pair<std::size_t, Vec3>> forces;
  visit_contacts(scene, state, [&](const ContactPoint& p) {
    const Vec3 t = cross(p.geometry.n, {0.3, -0.5, 0.8});
    forces.emplace_back(p.entry, t * (mobilised * p.limit / norm(t)));
  });
  for (const auto& [c, t] : forces)
    for (int k = 0; k < 3; ++k) state.contacts.history_at(c, static_cast<std::size_t>(k)) = t[k];
  return state;
}

TEST(Consistent, StickingWithoutShearIsNearlyTheElasticMatrix) {
  const Scene scene = test::lattice_scene("hertz-mindlin", "fcc", {2, 2, 2}, 1e-6);
  State state = test::state_of(scene);
  { Engine lists(scene, state); }
  const Network net = linearise(scene, state);
  const auto report = consistent_report(scene, state, net);
  const double lambda = step_interval(net).lambda_lower;
  EXPECT_TRUE(report.complete);
  EXPECT_EQ(report.sliding, 0u);
  EXPECT_LT(report.asymmetry, 1e-5);
  EXPECT_EQ(report.spectrum.flutter, 0u);
  EXPECT_NEAR(report.spectrum.radius, lambda, 1e-4 * lambda);
  EXPECT_GE(report.radius_upper, report.spectrum.radius);
}

TEST(Consistent, SlidingIsAsymmetricAndBothMethodsAgree) {
  const Scene scene = test::scene_of("hertz-mindlin");
  const State state = sheared(scene, 1.05);
  const Network net = linearise(scene, state);
  const auto all = consistent_report(scene, state, net);
  EXPECT_GT(all.asymmetry, 0.02);
  EXPECT_EQ(all.sliding, all.contacts);
  EXPECT_GT(all.spectrum.flutter + all.spectrum.collapse, 0u);
  EXPECT_GE(all.radius_upper, all.spectrum.radius);
  const auto ends = consistent_report(scene, state, net, {.dense_limit = 0, .wanted = 12});
  EXPECT_FALSE(ends.complete);
  EXPECT_NEAR(ends.spectrum.radius, all.spectrum.radius, 1e-6 * all.spectrum.radius);
  EXPECT_NEAR(ends.spectrum.collapse_rate, all.spectrum.collapse_rate, 1e-4 * all.spectrum.collapse_rate);
  EXPECT_DOUBLE_EQ(ends.asymmetry, all.asymmetry);
}

}  // namespace
}  // namespace eg
