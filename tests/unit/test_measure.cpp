#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/random.hpp"
#include "measure/contact_network.hpp"
#include "measure/fabric.hpp"
#include "measure/stress.hpp"
#include "measure/tensor.hpp"
#include "measure/volume.hpp"

using namespace eg;

namespace {

constexpr double pi = std::numbers::pi;

ContactPoint link(Index i, Index j) {
  ContactPoint c;
  c.i = i, c.j = j;
  return c;
}

Mat3 rotation(Random& random) {  // by a random quaternion
  double q[4], square = 0;
  for (double& v : q) v = random.normal(), square += v * v;
  for (double& v : q) v /= std::sqrt(square);
  const auto [w, x, y, z] = q;
  Mat3 r;
  r.a = {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
         2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
         2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
  return r;
}

}  // namespace

TEST(Tensor, InvariantsAreInvariant) {
  Random random(1);
  for (int k = 0; k < 50; ++k) {
    const double a = random.uniform(-2, 2), b = random.uniform(-2, 2), c = random.uniform(-2, 2);
    Mat3 m;
    m(0, 0) = a, m(1, 1) = b, m(2, 2) = c;
    const Mat3 r = rotation(random), turned = r * m * transpose(r);
    std::array expected{a, b, c};
    std::sort(expected.begin(), expected.end(), std::greater<>());
    const auto values = principal(turned, 3).values;
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(values[i], expected[i], 1e-14);
    EXPECT_NEAR(mean_value(turned, 3), (a + b + c) / 3, 1e-14);
    EXPECT_NEAR(deviator(turned, 3), deviator(m, 3), 1e-14);
  }
}

TEST(Tensor, DeviatorIsTheStressDifference) {
  Mat3 triaxial, plane;
  triaxial(0, 0) = triaxial(1, 1) = 100, triaxial(2, 2) = 250;
  EXPECT_NEAR(deviator(triaxial, 3), 150, 1e-12);
  plane(0, 0) = 3, plane(1, 1) = 1, plane(0, 1) = plane(1, 0) = 1, plane(2, 2) = 77;
  const auto [major, minor, none] = principal(plane, 2).values;
  EXPECT_NEAR(major, 2 + std::sqrt(2.0), 1e-14);
  EXPECT_NEAR(minor, 2 - std::sqrt(2.0), 1e-14);
  EXPECT_EQ(none, 0);
  EXPECT_NEAR(deviator(plane, 2), major - minor, 1e-14);
  EXPECT_NEAR(mean_value(plane, 2), 2, 1e-14);
  EXPECT_EQ(principal(Mat3{}, 3).values, (std::array<double, 3>{}));
}

TEST(ContactNetwork, CoordinationCountsEnds) {
  // 0–1, 1–2, 2–0, 2–3, 4 alone, 0 on a wall, 5 on its own image
  const std::vector<ContactPoint> contacts{link(0, 1), link(1, 2),        link(0, 2),
                                           link(2, 3), link(0, no_index), link(5, 5)};
  EXPECT_EQ(contacts_per_grain(6, contacts), (std::vector{3, 2, 3, 1, 0, 2}));
  const auto c = coordination(6, contacts);
  EXPECT_EQ(c.contacts, 5u);
  EXPECT_EQ(c.wall_contacts, 1u);
  EXPECT_EQ(c.isolated, 1u);
  EXPECT_EQ(c.dangling, 1u);
  EXPECT_DOUBLE_EQ(c.mean, 11. / 6);
  EXPECT_DOUBLE_EQ(c.mechanical, 10. / 4);
  const auto none = coordination(3, {});
  EXPECT_EQ(none.mean, 0);
  EXPECT_EQ(none.mechanical, 0);
}

TEST(ContactNetwork, RattlersAreFoundAgainAndAgain) {
  // a triangle 0-1-2 with a tail 2–3–4–5; a chain falls link by link
  const std::vector<ContactPoint> contacts{link(0, 1), link(1, 2), link(0, 2), link(2, 3), link(3, 4), link(4, 5)};
  EXPECT_EQ(find_rattlers(7, contacts, 2), (std::vector{false, false, false, true, true, true, true}));
  const auto b = backbone(7, contacts, 2);
  EXPECT_EQ(b.grains, 3u);
  EXPECT_EQ(b.contacts, 3u);
  EXPECT_DOUBLE_EQ(b.mean, 2);
  EXPECT_EQ(backbone(7, contacts, 3).grains, 0u);
  EXPECT_EQ(backbone(7, contacts, 3).mean, 0);
}

TEST(ContactNetwork, BackboneDoesNotDependOnTheOrder) {
  Random random(3);
  const std::size_t n = 200;
  std::vector<ContactPoint> contacts, mirrored;
  for (int k = 0; k < 350; ++k) {
    const auto i = static_cast<Index>(random.below(n)), j = static_cast<Index>(random.below(n));
    if (i == j) continue;
    contacts.push_back(link(i, j));
    const auto flip = [&](Index x) { return static_cast<Index>(n - 1 - x); };
    mirrored.push_back(link(flip(j), flip(i)));
  }
  for (int minimum = 1; minimum <= 4; ++minimum) {
    const auto rattles = find_rattlers(n, contacts, minimum), other = find_rattlers(n, mirrored, minimum);
    std::vector<int> ends(n);
    for (const auto& c : contacts)
      if (!rattles[c.i] && !rattles[c.j]) ++ends[c.i], ++ends[c.j];
    for (std::size_t i = 0; i < n; ++i) {
      EXPECT_EQ(rattles[i], other[n - 1 - i]);
      if (!rattles[i]) {
        EXPECT_GE(ends[i], minimum);
      }
    }
  }
}

TEST(ContactNetwork, FabricOfIsotropicNormalsIsAThirdOfTheIdentity) {
  Random random(3);
  std::vector<ContactPoint> contacts;
  for (int k = 0; k < 20000; ++k) {
    const Vec3 v{random.normal(), random.normal(), random.normal()};
    contacts.push_back(link(0, 1));
    contacts.back().geometry.n = (1 / norm(v)) * v;
  }
  contacts.push_back(link(0, no_index));  // walls do not count
  contacts.back().geometry.n = {0, 0, 1e6};
  const Mat3 fabric = fabric_tensor(contacts);
  EXPECT_NEAR(trace(fabric), 1, 1e-12);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(fabric(i, j), i == j ? 1. / 3 : 0, 0.01);
  EXPECT_EQ(fabric_tensor({}).a, Mat3{}.a);
}

TEST(Volume, CapsAndLenses) {
  EXPECT_NEAR(cap_volume(3, 1, 0.7), 0.2544690049, 1e-10);
  for (const int dimension : {2, 3}) {
    const double whole = grain_volume(dimension, 1.5);
    EXPECT_NEAR(cap_volume(dimension, 1.5, 0), whole / 2, 1e-14);
    EXPECT_NEAR(cap_volume(dimension, 1.5, -1.5), whole, 1e-13);
    EXPECT_EQ(cap_volume(dimension, 1.5, 1.5), 0);
    for (const double h : {0.1, 0.6, 1.2})
      EXPECT_NEAR(cap_volume(dimension, 1.5, h) + cap_volume(dimension, 1.5, -h), whole, 1e-13);
    EXPECT_EQ(lens_volume(dimension, 1, 2, 3), 0);
    EXPECT_EQ(lens_volume(dimension, 1, 2, 4), 0);
    EXPECT_NEAR(lens_volume(dimension, 1, 2, 1), grain_volume(dimension, 1), 1e-12);
    EXPECT_NEAR(lens_volume(dimension, 1, 2, 1 + 1e-9), grain_volume(dimension, 1), 1e-8);
    EXPECT_NEAR(lens_volume(dimension, 1, 2, 2.5), lens_volume(dimension, 2, 1, 2.5), 1e-15);
    // the lens grows by the area (2D: chord) of its edge circle as the centres close in
    const double r1 = 1, r2 = 2, d = 2.4, step = 1e-5, x = (d * d + r1 * r1 - r2 * r2) / (2 * d);
    const double half_chord = std::sqrt(r1 * r1 - x * x);
    const double rate =
        (lens_volume(dimension, r1, r2, d - step) - lens_volume(dimension, r1, r2, d + step)) / (2 * step);
    EXPECT_NEAR(rate, dimension == 3 ? pi * half_chord * half_chord : 2 * half_chord, 1e-8);
  }
  const double thin = 1e-5;  // (4/3) r² (2h/r)^1.5 /2 … to first order (4√2/3) √r h^1.5
  EXPECT_NEAR(cap_volume(2, 2, 2 - thin) / (4 * std::sqrt(2.) / 3 * std::sqrt(2.) * std::pow(thin, 1.5)), 1, 1e-5);
  const double switch_over = 2 * (1 - std::cos(0.5e-2));  // both branches of the thin cap meet
  EXPECT_NEAR(cap_volume(2, 2, 2 - switch_over * (1 + 1e-9)) / cap_volume(2, 2, 2 - switch_over * (1 - 1e-9)), 1, 1e-8);
}

TEST(Volume, SpecimenBetweenWalls) {
  State state;
  state.cell.h(0, 0) = 2, state.cell.h(1, 1) = 3, state.cell.h(2, 2) = 4;
  EXPECT_EQ(specimen_volume(state), 24);
  Wall floor, lid;
  floor.normal = {0, 0, 1}, lid.normal = {0, 0, -1}, floor.point = {0, 0, 1}, lid.point = {0, 0, 1.5};
  state.walls = {floor};
  EXPECT_EQ(specimen_volume(state), 24);
  state.walls = {floor, lid};
  EXPECT_EQ(specimen_volume(state), 3);
}

TEST(Volume, HalvesOfAShearBoxStayAsWideAsTheyWere) {
  State state;
  state.cell.h(0, 0) = 9, state.cell.h(1, 1) = 3, state.cell.h(2, 2) = 4;
  for (const bool upper : {false, true}) {
    Wall left, right;
    left.normal = {1, 0, 0}, right.normal = {-1, 0, 0}, right.point = {2, 0, 0};
    left.along = right.along = {0, 0, 1};
    (upper ? left.low : left.high) = 2, (upper ? right.low : right.high) = 2;
    if (!upper) left.point.x += 0.5, right.point.x += 0.5;  // it has moved
    state.walls.push_back(left), state.walls.push_back(right);
  }
  EXPECT_EQ(specimen_volume(state), 2 * 3 * 4);
  Wall stop;
  stop.normal = {-1, 0, 0}, stop.point = {1, 0, 0};  // stands before both
  state.walls.push_back(stop);
  EXPECT_EQ(wall_gap(state, 0).length(), 0.5);
}

TEST(Volume, AQuarterOfAHollowCylinder) {
  State state;
  state.cell.h(2, 2) = 2;
  Wall outer, inner;
  outer.shape = inner.shape = Wall::cylinder, outer.normal = inner.normal = {0, 0, 1};
  outer.radius = 5, inner.radius = 3, inner.hollow = false, outer.angle = inner.angle = pi / 2;
  state.walls = {outer, inner};
  EXPECT_DOUBLE_EQ(specimen_volume(state), pi / 4 * (25 - 9) * 2);
  EXPECT_EQ(round_section(state, {1, 0, 0}), 0);
}

TEST(Volume, SizeStatistics) {
  State state;
  for (const double r : {1., 1., 1., 2.}) state.grains.position.push_back({0, 0, 0, r});
  const auto sizes = size_statistics(state);
  EXPECT_EQ(sizes.smallest, 2);
  EXPECT_EQ(sizes.largest, 4);
  EXPECT_DOUBLE_EQ(sizes.mean, 2.5);
  EXPECT_DOUBLE_EQ(sizes.deviation, std::sqrt(0.75));
  EXPECT_EQ(sizes.d50, 4);  // 8 of 11 parts of the mass
  EXPECT_DOUBLE_EQ(solid_volume(state), 4 * pi / 3 * 11);
}

TEST(Stress, OnePairCarriesItsForceOverTheBranch) {
  ContactPoint c = link(0, 1);
  c.branch = {0, 0, 2};
  c.geometry.n = {0, 0, 1};
  c.normal.force = 6;
  c.shear = {-1, 0, 0};
  const Mat3 s = stress(std::vector{c}, 4.0);
  EXPECT_DOUBLE_EQ(s(2, 2), 3);    // repulsion is compression
  EXPECT_DOUBLE_EQ(s(0, 2), 0.5);  // force on j is N n − T
  EXPECT_DOUBLE_EQ(s(2, 0), 0);
}

TEST(Stress, NetForcesBalanceAndIgnoreFixedGrains) {
  State state;
  state.grains.position.resize(3);
  state.grains.velocity.assign(3, {0, 0, 0, 0.5});
  state.grains.velocity[2].w = 0;
  ContactPoint a = link(0, 1), b = link(1, 2);
  a.geometry.n = b.geometry.n = {0, 0, 1};
  a.normal.force = 3, b.normal.force = 5;
  const std::vector contacts{a, b};
  const auto net = net_forces(state, contacts, {0, 0, -1});
  EXPECT_DOUBLE_EQ(net[0].z, -3 - 2);
  EXPECT_DOUBLE_EQ(net[1].z, 3 - 5 - 2);
  EXPECT_EQ(net[2].z, 0);
  EXPECT_DOUBLE_EQ(unbalanced_force(state, contacts, {0, 0, -1}), (9. / 2) / 4);
  EXPECT_EQ(unbalanced_force(state, {}, {}), 1);
}

TEST(Stress, Energies) {
  State state;
  state.grains.velocity = {{3, 0, 4, 0.5}, {1, 1, 1, 0}};
  state.grains.spin = {{0, 2, 0, 0.25}, {1, 1, 1, 0}};
  EXPECT_DOUBLE_EQ(kinetic_energy(state), 25 + 8);
  ContactPoint c = link(0, 1);
  c.normal_energy = 2, c.shear_energy = 0.5;
  EXPECT_DOUBLE_EQ(elastic_energy(std::vector{c}), 2.5);
  EXPECT_DOUBLE_EQ(inertial_number(-2, 1e-3, 2500, 1e4), 2e-3 * 0.5);
}
