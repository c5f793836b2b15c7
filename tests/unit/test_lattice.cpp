#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "specimen/lattice.hpp"

using namespace eg;

namespace {

constexpr double pi = std::numbers::pi;

struct Expected {
  const char* name;
  int coordination;
  double solid_fraction;
};
const Expected table[] = {{"sc", 6, pi / 6},
                          {"bcc", 8, pi* std::sqrt(3.0) / 8},
                          {"fcc", 12, pi / (3 * std::sqrt(2.0))},
                          {"fcc-110", 12, pi / (3 * std::sqrt(2.0))},
                          {"fcc-111", 12, pi / (3 * std::sqrt(2.0))},
                          {"hcp", 12, pi / (3 * std::sqrt(2.0))},
                          {"square", 4, pi / 4},
                          {"hexagonal", 6, pi / (2 * std::sqrt(3.0))}};

/// Branch vectors from grain i to all grains (and images) nearer than `reach`.
std::vector<Vec3> branches(const Packing& p, std::size_t i, double reach) {
  std::vector<Vec3> found;
  const auto range = [&](int k) { return p.periodic[static_cast<std::size_t>(k)] ? 2 : 0; };
  for (std::size_t j = 0; j < p.size(); ++j)
    for (int a = -range(0); a <= range(0); ++a)
      for (int b = -range(1); b <= range(1); ++b)
        for (int c = -range(2); c <= range(2); ++c) {
          if (i == j && a == 0 && b == 0 && c == 0) continue;
          const Vec3 l = p.position[j] - p.position[i] + Vec3{a * p.box.x, b * p.box.y, c * p.box.z};
          if (norm(l) < reach) found.push_back(l);
        }
  return found;
}

double solid_fraction(const Packing& p) {
  double solid = 0;
  for (const double r : p.radius) solid += p.dimension == 3 ? 4 * pi / 3 * r * r * r : pi * r * r;
  return solid / (p.box.x * p.box.y * p.box.z);
}

double hertz(double radius, double overlap) { return 4e10 / 3 * std::sqrt(radius / 2) * overlap * std::sqrt(overlap); }

}  // namespace

TEST(Lattice, CoordinationFabricAndSolidFraction) {
  for (const auto& expected : table)
    for (const std::array<int, 3> cells : {std::array{1, 1, 1}, std::array{2, 3, 2}}) {
      SCOPED_TRACE(expected.name);
      Random random(1);
      const auto cell = find_lattice(expected.name);
      ASSERT_TRUE(cell);
      const Packing p = make_lattice(*cell, {.cells = cells, .radius = 2.0}, random);
      EXPECT_NEAR(solid_fraction(p), expected.solid_fraction, 1e-14);
      for (std::size_t i = 0; i < p.size(); ++i) {
        const auto touching = branches(p, i, 4.0 * 1.1);
        EXPECT_EQ(touching.size(), expected.coordination);
        Mat3 fabric;
        for (const Vec3& l : touching) {
          EXPECT_NEAR(norm(l), 4.0, 1e-13);
          fabric += outer(l, l);
        }
        for (int a = 0; a < cell->dimension; ++a)
          for (int b = 0; b < cell->dimension; ++b)
            EXPECT_NEAR(fabric(a, b), a == b ? 16. * expected.coordination / cell->dimension : 0, 1e-12);
      }
    }
}

TEST(Lattice, OverlapSetsTheCentreDistance) {
  Random random(1);
  for (const double overlap : {0.0, 1e-6, 1e-3, 0.1, -0.2}) {
    const Packing p =
        make_lattice(*find_lattice("fcc"), {.cells = {2, 2, 2}, .radius = 1.5, .relative_overlap = overlap}, random);
    const auto touching = branches(p, 0, 3.0 * (1 - overlap) * 1.2);
    ASSERT_EQ(touching.size(), 12u);
    for (const Vec3& l : touching) EXPECT_NEAR(norm(l), 3.0 * (1 - overlap), 1e-14);
  }
}

TEST(Lattice, FreeBoxTouchesTheOutermostGrains) {
  Random random(3);
  for (const auto& expected : table) {
    const auto cell = find_lattice(expected.name);
    const Packing p =
        make_lattice(*cell, {.cells = {3, 2, 4}, .radius = 0.5, .radius_scatter = 0.03, .periodic = false}, random);
    EXPECT_EQ(p.size(), cell->sites.size() * (cell->dimension == 3 ? 24 : 6));
    for (int k = 0; k < cell->dimension; ++k) {
      double low = 1e9, high = -1e9;
      for (std::size_t i = 0; i < p.size(); ++i) {
        low = std::min(low, p.position[i][k] - p.radius[i]);
        high = std::max(high, p.position[i][k] + p.radius[i]);
      }
      EXPECT_NEAR(low, 0, 1e-14);
      EXPECT_NEAR(high, p.box[k], 1e-14);
      EXPECT_FALSE(p.periodic[static_cast<std::size_t>(k)]);
    }
  }
}

TEST(Lattice, PressureEqualsTheVirialOfTheContactForces) {
  for (const auto& expected : table) {
    SCOPED_TRACE(expected.name);
    const auto cell = find_lattice(expected.name);
    const double radius = 1e-3, overlap = 0.02;
    Random random(1);
    const Packing p = make_lattice(*cell, {.cells = {2, 2, 2}, .radius = radius, .relative_overlap = overlap}, random);
    Mat3 stress;
    for (std::size_t i = 0; i < p.size(); ++i)
      for (const Vec3& l : branches(p, i, 2 * radius))
        stress += (0.5 * hertz(radius, 2 * radius - norm(l)) / norm(l)) * outer(l, l);
    const double volume = p.box.x * p.box.y * p.box.z;
    const double pressure = lattice_pressure(*cell, radius, overlap, hertz);
    for (int a = 0; a < cell->dimension; ++a)
      for (int b = 0; b < cell->dimension; ++b)
        EXPECT_NEAR(stress(a, b) / volume, a == b ? pressure : 0, 1e-12 * pressure);
  }
}

TEST(Lattice, OverlapFromPressureIsExact) {
  for (const auto& expected : table)
    for (const double pressure : {1e-3, 1.0, 1e4}) {
      SCOPED_TRACE(expected.name);
      const auto cell = find_lattice(expected.name);
      const auto overlap = lattice_overlap(*cell, 1e-3, pressure, hertz);
      ASSERT_TRUE(overlap);
      EXPECT_NEAR(lattice_pressure(*cell, 1e-3, *overlap, hertz) / pressure, 1, 1e-14);
    }
  EXPECT_FALSE(lattice_overlap(*find_lattice("sc"), 1e-3, 1e12, hertz));
}

TEST(Lattice, FccContactForceUnderPressure) {  // N = √2 p R², exact at vanishing overlap (Duffy and Mindlin 1957)
  const double radius = 1e-3, pressure = 1.0;
  const double overlap = *lattice_overlap(*find_lattice("fcc"), radius, pressure, hertz);
  const double distance_ratio = 1 - overlap;
  EXPECT_NEAR(hertz(radius, 2 * radius * overlap),
              std::sqrt(2.0) * pressure * radius * radius * distance_ratio * distance_ratio, 1e-12 * 1.4e-6);
}

TEST(Lattice, ScatterIsNormalCutAtThreeDeviations) {
  Random random(11), again(11), other(12);
  const auto cell = *find_lattice("hexagonal");
  const LatticeSize size{.cells = {120, 120, 1}, .radius = 2.0, .relative_overlap = 0.01, .radius_scatter = 0.05};
  const Packing p = make_lattice(cell, size, random);
  const double n = static_cast<double>(p.size());
  double mean = 0, variance = 0, largest = 0;
  for (const double r : p.radius) {
    mean += r / n;
    largest = std::max(largest, r);
    EXPECT_LE(std::abs(r - 2.0), 0.3);
  }
  for (const double r : p.radius) variance += (r - mean) * (r - mean) / n;
  EXPECT_NEAR(mean, 2.0, 4 * 0.1 / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(variance) / 0.1, 0.9866, 4 / std::sqrt(2 * n));  // 0.9866: a normal cut at 3 SD
  EXPECT_NEAR(p.box.x, 120 * 2 * largest * 0.99, 1e-12 * p.box.x);
  EXPECT_EQ(make_lattice(cell, size, again).radius, p.radius);
  EXPECT_NE(make_lattice(cell, size, other).radius, p.radius);
}

TEST(Lattice, UnknownName) {
  EXPECT_FALSE(find_lattice("fc"));
  for (const auto& name : lattice_names()) EXPECT_TRUE(find_lattice(name));
}
