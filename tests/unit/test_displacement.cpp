// Displacements between two states, local strain, shear bands: synthetic motions whose answer is known.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "base/random.hpp"
#include "measure/displacement.hpp"
#include "measure/shear_band.hpp"

namespace eg {
namespace {

constexpr double pi = std::numbers::pi;

/// Grains anywhere in a block of edges 1 × 1 × 2 (2D: 1 × 2), numbered backwards.
State block(int dimension, std::size_t count, bool periodic, std::uint64_t seed = 2) {
  Random random(seed);
  State state;
  state.dimension = dimension;
  const bool solid = dimension == 3;
  state.cell.h(1, 1) = solid ? 1 : 2, state.cell.h(2, 2) = solid ? 2 : 1;
  state.cell.periodic = {periodic, periodic, periodic && solid};
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 f{random.uniform(), random.uniform(), solid ? random.uniform() : 0};
    const Vec3 x = state.cell.h * f;
    state.grains.position.push_back({x.x, x.y, x.z, 0.01});
    state.grains.id.push_back(static_cast<Index>(count - i));
  }
  state.grains.velocity.resize(count);
  return state;
}

template <class F>
State moved(State state, const F& displacement) {
  for (auto& x : state.grains.position) x.set(x.vec() + displacement(x.vec()));
  return state;
}

TEST(Displacement, GrainsAreKnownByTheirIds) {
  const State before = block(3, 50, false);
  State now = moved(before, [](const Vec3& x) { return Vec3{0.1 * x.z, 0, -0.2}; });
  std::reverse(now.grains.position.begin(), now.grains.position.end());
  std::reverse(now.grains.id.begin(), now.grains.id.end());
  now.grains.position.pop_back(), now.grains.id.pop_back(), now.grains.velocity.pop_back();  // one is lost
  const Displacements motion = displacements_between(before, now);
  ASSERT_EQ(motion.size(), 49u);
  for (std::size_t i = 0; i < motion.size(); ++i) {
    EXPECT_NEAR(motion.displacement[i].x, 0.1 * motion.from[i].z, 1e-15);
    EXPECT_NEAR(motion.displacement[i].z, -0.2, 1e-15);
    EXPECT_EQ(motion.now[i], i);
  }
  State strangers = before;
  for (auto& id : strangers.grains.id) id += 1000;
  EXPECT_THROW(displacements_between(before, strangers), InputError);
  EXPECT_THROW(displacements_between(block(2, 5, false), before), InputError);
}

TEST(Displacement, PeriodicGrainsAreFollowedThroughFacesAndRenamedCells) {
  const State before = block(3, 200, true);
  Mat3 gradient;
  gradient(0, 0) = -0.05, gradient(1, 1) = 0.02, gradient(2, 2) = 0.1;
  gradient(0, 1) = 0.2, gradient(0, 2) = 0.22, gradient(1, 2) = -0.2;
  Random random(9);
  State now = before;
  now.cell.h = (Mat3::identity() + gradient) * before.cell.h;
  std::vector<Vec3> expected;
  for (auto& x : now.grains.position) {
    const Vec3 own{random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1)};
    expected.push_back(gradient * x.vec() + own);
    x.set(x.vec() + expected.back());
  }
  now.cell.straighten();
  for (auto& x : now.grains.position) {  // into the renamed cell
    Vec3 f = now.cell.fractional(x.vec());
    for (int k = 0; k < 3; ++k) f[k] -= std::floor(f[k]);
    x.set(now.cell.h * f);
  }
  const Displacements motion = displacements_between(before, now);
  for (std::size_t k = 0; k < 9; ++k) EXPECT_NEAR(motion.gradient.a[k], gradient.a[k], 1e-14);
  for (std::size_t i = 0; i < motion.size(); ++i) EXPECT_NEAR(norm(motion.displacement[i] - expected[i]), 0, 1e-13);
}

TEST(Displacement, LocalGradientsOfAHomogeneousMotionAreExact) {
  for (const int dimension : {2, 3})
    for (const bool periodic : {false, true}) {
      const State before = block(dimension, 400, periodic);
      Mat3 gradient;
      gradient(0, 0) = -0.03, gradient(0, 1) = 0.1, gradient(1, 1) = 0.05;
      if (dimension == 3) gradient(2, 2) = 0.02, gradient(0, 2) = -0.04;
      State now = moved(before, [&](const Vec3& x) { return gradient * x; });
      now.cell.h = (Mat3::identity() + gradient) * before.cell.h;
      const Displacements motion = displacements_between(before, now);
      for (const auto& g : local_gradients(motion, 0.45))
        for (std::size_t k = 0; k < 9; ++k) EXPECT_NEAR(g.a[k], gradient.a[k], 1e-12);
      const auto inside = displacement_inside(motion, {{0.5, 0.6, dimension == 3 ? 0.7 : 0}, 0.4});
      ASSERT_TRUE(inside.gradient);
      for (std::size_t k = 0; k < 9; ++k) EXPECT_NEAR(inside.gradient->a[k], gradient.a[k], 1e-12);
      EXPECT_GT(inside.grains, 10u);
    }
}

TEST(Displacement, StrainDoesNotSeeRotations) {
  Mat3 turn;
  turn(1, 0) = 0.01, turn(0, 1) = -0.01;
  EXPECT_NEAR(strain_of(turn, 2).shear, 0, 1e-15);
  EXPECT_NEAR(strain_of(turn, 3).rotation.z, 0.01, 1e-15);
  Mat3 shear;
  shear(0, 1) = 0.02;
  EXPECT_NEAR(strain_of(shear, 2).shear, 0.02, 1e-15);
  EXPECT_NEAR(strain_of(shear, 2).rotation.z, -0.01, 1e-15);
  Mat3 squeeze;
  squeeze(2, 2) = -0.03, squeeze(0, 0) = squeeze(1, 1) = 0.01;
  EXPECT_NEAR(strain_of(squeeze, 3).shear, 0.04, 1e-15);
  EXPECT_NEAR(strain_of(squeeze, 3).volumetric, 0.01, 1e-15);
}

TEST(Displacement, GaugesAreTheNearestGrains) {
  const State before = block(3, 300, true);
  const Displacements motion = displacements_between(before, before);
  for (const std::size_t i : {0u, 17u, 200u})
    EXPECT_EQ(nearest_grain(motion, motion.from[i] + Vec3{1e-4, 3 - 1e-4, 0}), i);  // three cells away
}

struct Layer {
  Vec3 normal, slip;
  double position, thickness;
  Vec3 operator()(const Vec3& x) const {
    return std::clamp((dot(normal, x) - position) / thickness, -0.5, 0.5) * slip + Vec3{0.02 * x.x, 0, -0.01 * x.y};
  }
};

void expect_band(const Layer& layer, int dimension, double noise, double tolerance) {
  Random random(6);
  const State before = block(dimension, 3000, false, 8);
  const State now = moved(before, [&](const Vec3& x) {
    const Vec3 own{random.normal(), random.normal(), dimension == 3 ? random.normal() : 0};
    return layer(x) + noise * own;
  });
  const Displacements motion = displacements_between(before, now);
  const auto band = find_shear_band(motion.from, motion.displacement, dimension);
  ASSERT_TRUE(band);
  EXPECT_NEAR(std::abs(dot(band->normal, layer.normal)), 1, tolerance * tolerance + 1e-9);
  EXPECT_NEAR(band->thickness / layer.thickness, 1, 5 * tolerance);
  EXPECT_NEAR(band->position, layer.position, tolerance);
  EXPECT_NEAR(norm(band->jump - layer.slip), 0, tolerance * norm(layer.slip));
  EXPECT_GT(band->explained, noise > 0 ? 0.8 : 0.9999);
}

TEST(ShearBand, FindsABandOfKnownPlaceThicknessAndInclination) {
  for (const double inclination : {40., 62.}) {
    const double a = inclination * pi / 180;
    const Layer flat{{std::sin(a), -std::cos(a), 0}, 0.05 * Vec3{std::cos(a), std::sin(a), 0}, -0.2, 0.15};
    expect_band(flat, 2, 0, 1e-3);
    expect_band(flat, 2, 0.002, 0.02);
    const Layer solid{{std::sin(a) * 0.8, std::sin(a) * 0.6, -std::cos(a)},
                      0.05 * Vec3{std::cos(a) * 0.8, std::cos(a) * 0.6, std::sin(a)},
                      0.1,
                      0.2};
    expect_band(solid, 3, 0, 2e-3);
    expect_band(solid, 3, 0.002, 0.03);
  }
}

TEST(ShearBand, AHomogeneousMotionHasNone) {
  const State before = block(2, 2000, false);
  Random random(3);
  const State now = moved(before, [&](const Vec3& x) {
    return Vec3{0.05 * x.y + 1e-3 * random.normal(), -0.1 * x.y + 1e-3 * random.normal(), 0};
  });
  const Displacements motion = displacements_between(before, now);
  EXPECT_LT(find_shear_band(motion.from, motion.displacement, 2)->explained, 0.05);
  EXPECT_FALSE(find_shear_band({}, {}, 2));
}

}  // namespace
}  // namespace eg
