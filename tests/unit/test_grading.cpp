#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "specimen/grading.hpp"

using namespace eg;

TEST(Grading, SampleFollowsTheTableByMass) {
  const Grading toyoura = *grading_preset("toyoura");
  for (const int dimension : {2, 3})
    for (const std::size_t count : {2000u, 100000u}) {
      Random random(5);
      const auto radii = draw_radii(toyoura, dimension, count, random);
      ASSERT_EQ(radii.size(), count);
      std::vector<double> diameters, expected;
      for (std::size_t k = 0; k < toyoura.passing.size(); ++k) {
        diameters.push_back(toyoura.passing[k][0]);
        expected.push_back(toyoura.passing[k][1]);
        if (k == 0) continue;  // half-way: mass is uniform in d inside an interval
        diameters.push_back((toyoura.passing[k - 1][0] + toyoura.passing[k][0]) / 2);
        expected.push_back((toyoura.passing[k - 1][1] + toyoura.passing[k][1]) / 2);
      }
      const auto passing = passing_by_mass(radii, dimension, diameters);
      for (std::size_t k = 0; k < diameters.size(); ++k)
        EXPECT_NEAR(passing[k], expected[k], count == 2000 ? 8e-3 : 3e-4) << dimension << " " << diameters[k];
    }
}

TEST(Grading, EmptySieveStaysEmpty) {
  Grading gap;
  gap.kind = Grading::Kind::table;
  gap.passing = {{1, 0}, {2, .5}, {3, .5}, {4, 1}};
  Random random(5);
  std::size_t fine = 0;
  const auto radii = draw_radii(gap, 3, 10000, random);
  for (const double r : radii) {
    EXPECT_TRUE((r >= 0.5 && r <= 1) || (r >= 1.5 && r <= 2));
    fine += r <= 1;
  }
  // by number ∝ ∫ d⁻³: (1 − 1/4) to (1/9 − 1/16)
  EXPECT_NEAR(static_cast<double>(fine) / 1e4, 0.75 / (0.75 + 1. / 9 - 1. / 16), 1e-3);
}

TEST(Grading, UniformByNumber) {
  Grading uniform;
  uniform.kind = Grading::Kind::uniform;
  uniform.min_radius = 2, uniform.max_radius = 3;
  Random random(5);
  auto radii = draw_radii(uniform, 3, 1000, random);
  EXPECT_FALSE(std::is_sorted(radii.begin(), radii.end()));
  double correlation = 0;  // of successive grains: the order is shuffled
  for (std::size_t i = 1; i < radii.size(); ++i) correlation += (radii[i] - 2.5) * (radii[i - 1] - 2.5) * 12 / 1000;
  EXPECT_NEAR(correlation, 0, 0.15);
  std::sort(radii.begin(), radii.end());
  for (std::size_t i = 0; i < radii.size(); ++i) EXPECT_NEAR(radii[i], 2 + (static_cast<double>(i) + .5) / 1000, 5e-4);
}

TEST(Grading, SingleSizeAndSeeds) {
  Grading single;
  single.min_radius = single.max_radius = 0.25;
  Random random(1), again(1), other(2);
  EXPECT_EQ(draw_radii(single, 2, 3, random), (std::vector<double>{0.25, 0.25, 0.25}));
  Random third(1);
  const auto toyoura = *grading_preset("toyoura");
  const auto radii = draw_radii(toyoura, 3, 100, again);
  EXPECT_EQ(draw_radii(toyoura, 3, 100, third), radii);
  EXPECT_NE(draw_radii(toyoura, 3, 100, other), radii);
  EXPECT_FALSE(grading_preset("toyora"));
}
