#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "specimen/cloud.hpp"
#include "specimen/grading.hpp"

using namespace eg;

namespace {

constexpr double pi = std::numbers::pi;

/// Smallest gap between grains (and walls) over the sum of radii, all pairs and images tried.
double smallest_gap(const Packing& p) {
  double smallest = 1e9;
  for (std::size_t i = 0; i < p.size(); ++i) {
    for (int k = 0; k < p.dimension; ++k) {
      EXPECT_GE(p.position[i][k], 0);
      EXPECT_LT(p.position[i][k], p.box[k]);
      const double wall = std::min(p.position[i][k], p.box[k] - p.position[i][k]);
      if (!p.periodic[static_cast<std::size_t>(k)]) smallest = std::min(smallest, wall / p.radius[i] - 1);
    }
    for (std::size_t j = 0; j <= i; ++j) {
      Vec3 l = p.position[j] - p.position[i];
      for (int k = 0; k < 3; ++k)
        if (p.periodic[static_cast<std::size_t>(k)]) l[k] = std::remainder(l[k], p.box[k]);
      double distance = norm(l);
      if (i == j) {  // its own image
        if (!p.periodic[0]) continue;
        distance = std::min(p.box.x, std::min(p.box.y, p.dimension == 3 ? p.box.z : p.box.x));
      }
      smallest = std::min(smallest, distance / (p.radius[i] + p.radius[j]) - 1);
    }
  }
  return smallest;
}

double solid_fraction(const Packing& p) {
  double solid = 0;
  for (const double r : p.radius) solid += p.dimension == 3 ? 4 * pi / 3 * r * r * r : pi * r * r;
  return solid / (p.box.x * p.box.y * p.box.z);
}

Grading sizes(double smallest, double largest) {
  Grading grading;
  grading.kind = smallest == largest ? Grading::Kind::single : Grading::Kind::uniform;
  grading.min_radius = smallest, grading.max_radius = largest;
  return grading;
}

}  // namespace

struct CloudCase {
  int dimension;
  std::size_t count;
  double solid_fraction, smallest, largest;
  bool periodic;
};

class Clouds : public testing::TestWithParam<CloudCase> {};

TEST_P(Clouds, HaveNoOverlapAndTheGivenSolidFraction) {
  const auto c = GetParam();
  for (std::uint64_t seed = 1; seed <= (c.count < 1000 ? 5u : 1u); ++seed) {
    Random random(seed);
    const auto radii = draw_radii(sizes(c.smallest, c.largest), c.dimension, c.count, random);
    const CloudSpec spec{c.dimension, c.solid_fraction, {1, 0.5, 1.5}, c.periodic};
    const Packing p = make_cloud(radii, spec, random);
    EXPECT_EQ(p.radius, radii);
    EXPECT_GT(smallest_gap(p), 0);
    EXPECT_NEAR(solid_fraction(p), c.solid_fraction, 1e-12);
    EXPECT_NEAR(p.box.y / p.box.x, 0.5, 1e-12);
    EXPECT_EQ(p.periodic[2], c.periodic && c.dimension == 3);
    if (c.dimension == 2) {
      EXPECT_EQ(p.box.z, 1);
      for (const Vec3& x : p.position) EXPECT_EQ(x.z, 0);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, Clouds,
                         testing::Values(CloudCase{3, 200, 0.3, 1, 1, true}, CloudCase{3, 200, 0.3, 1e-3, 2e-2, true},
                                         CloudCase{3, 200, 0.5, 1, 1, true}, CloudCase{3, 300, 0.45, 1, 3, false},
                                         CloudCase{3, 8000, 0.5, 1, 2, true}, CloudCase{3, 2, 0.1, 1, 1, true},
                                         CloudCase{2, 200, 0.3, 1, 1, true}, CloudCase{2, 200, 0.6, 1, 1, true},
                                         CloudCase{2, 300, 0.6, 1, 20, false}, CloudCase{2, 5000, 0.7, 1, 2, false}));

TEST(Cloud, SameSeedSameCloud) {
  const std::vector<double> radii(500, 1.0);
  Random a(4), b(4), c(5);
  const Packing first = make_cloud(radii, {}, a), second = make_cloud(radii, {}, b), third = make_cloud(radii, {}, c);
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(norm(first.position[i] - second.position[i]), 0);
  EXPECT_NE(norm(first.position[7] - third.position[7]), 0);
}

TEST(Cloud, FillsTheBoxEvenly) {
  const std::vector<double> radii(20000, 1.0);
  Random random(4);
  const Packing p = make_cloud(radii, {}, random);
  for (int k = 0; k < 3; ++k) {
    std::size_t lower = 0;
    for (const Vec3& x : p.position) lower += x[k] < p.box[k] / 2;
    EXPECT_NEAR(static_cast<double>(lower), 10000, 4 * std::sqrt(20000.) / 2);
  }
}

TEST(Cloud, SizesMayDifferHundredfold) {
  Random random(4);
  std::vector<double> radii(3000, 0.01);
  radii[17] = 1;
  const Packing p = make_cloud(radii, {.solid_fraction = 0.4}, random);
  EXPECT_GT(smallest_gap(p), 0);
}

TEST(Cloud, ImpossibleOnesFailClearly) {
  Random random(4);
  const std::vector<double> radii(100, 1.0), one(1, 1.0);
  EXPECT_THROW(make_cloud(radii, {.solid_fraction = 0.8}, random), RunError);
  EXPECT_THROW(make_cloud(radii, {.dimension = 2, .solid_fraction = 0.95}, random), RunError);
  EXPECT_THROW(make_cloud(one, {.solid_fraction = 0.6}, random), RunError);
  EXPECT_THROW(make_cloud(radii, {.aspect = {1, 1, 1000}}, random), RunError);
}
