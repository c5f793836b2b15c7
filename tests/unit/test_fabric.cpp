// Directions and forces: fabric, rose diagrams, distributions, strong network, chains, size fractions.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "base/random.hpp"
#include "measure/distribution.hpp"
#include "measure/fabric.hpp"
#include "measure/force_chains.hpp"
#include "measure/force_network.hpp"
#include "measure/grain_stress.hpp"
#include "measure/homogenised.hpp"
#include "measure/rose.hpp"
#include "measure/stress.hpp"
#include "search/neighbours.hpp"
#include "support/scenes.hpp"

namespace eg {
namespace {

ContactPoint contact(Index i, Index j, const Vec3& direction, double force, const Vec3& shear = {}) {
  ContactPoint c;
  c.i = i, c.j = j;
  c.branch = direction;
  c.geometry.n = (1 / norm(direction)) * direction;
  c.geometry.arm_i = c.geometry.arm_j = norm(direction) / 2;
  c.normal.force = force;
  c.shear = shear;
  c.limit = 0.5 * force;
  return c;
}

/// Random contacts among n grains, with shear across n.
std::vector<ContactPoint> random_contacts(std::size_t grains, int count, Random& random) {
  std::vector<ContactPoint> all;
  for (int k = 0; k < count; ++k) {
    const auto i = static_cast<Index>(random.below(grains)), j = static_cast<Index>(random.below(grains));
    const Vec3 l{random.normal(), random.normal(), 2 * random.normal()};
    const Vec3 any{random.normal(), random.normal(), random.normal()};
    auto c = contact(i, j, l, random.uniform(0.1, 3));
    c.shear = 0.3 * c.normal.force * cross(c.geometry.n, any);
    c.geometry.arm_i = random.uniform(0.2, 0.8) * norm(l), c.geometry.arm_j = norm(l) - c.geometry.arm_i;
    all.push_back(c);
  }
  return all;
}

Mat3 turned(const Mat3& r, const Mat3& m) { return r * m * transpose(r); }

TEST(Fabric, TracesAreOneAndTensorsTurnWithThePacking) {
  Random random(2);
  auto contacts = random_contacts(10, 300, random);
  const Mat3 fabric = fabric_tensor(contacts), force = force_fabric_tensor(contacts);
  EXPECT_NEAR(trace(fabric), 1, 1e-12);
  EXPECT_NEAR(trace(force), 1, 1e-12);
  const double c = std::cos(0.7), s = std::sin(0.7);
  Mat3 r;
  r.a = {c, -s, 0, s, c, 0, 0, 0, 1};
  for (auto& p : contacts) p.geometry.n = r * p.geometry.n;
  for (std::size_t k = 0; k < 9; ++k) {
    EXPECT_NEAR(fabric_tensor(contacts).a[k], turned(r, fabric).a[k], 1e-12);
    EXPECT_NEAR(force_fabric_tensor(contacts).a[k], turned(r, force).a[k], 1e-12);
  }
}

TEST(Fabric, TwoDirections) {
  const std::vector contacts{contact(0, 1, {0, 0, 1}, 3), contact(0, 1, {0, 0, -1}, 3), contact(1, 2, {1, 0, 0}, 2),
                             contact(0, no_index, {0, 1, 0}, 99)};
  const Principal p = principal(fabric_tensor(contacts), 3);
  EXPECT_NEAR(p.values[0], 2. / 3, 1e-15);
  EXPECT_NEAR(p.values[1], 1. / 3, 1e-15);
  EXPECT_NEAR(anisotropy(p, 3), 2. / 3, 1e-15);
  EXPECT_NEAR(std::abs(p.axes[0].z), 1, 1e-15);
  EXPECT_NEAR(principal(force_fabric_tensor(contacts), 3).values[0], 6. / 8, 1e-15);
}

TEST(Fabric, AxesAreOrthonormalAndGiveTheTensorBack) {
  Random random(8);
  for (int k = 0; k < 20; ++k) {
    Mat3 m;
    for (double& x : m.a) x = random.normal();
    m += transpose(m);
    const Principal p = principal(m, 3);
    Mat3 back;
    for (std::size_t i = 0; i < 3; ++i) {
      back += p.values[i] * outer(p.axes[i], p.axes[i]);
      for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(dot(p.axes[i], p.axes[j]), i == j, 1e-13);
    }
    for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(back.a[i], m.a[i], 1e-12);
  }
}

TEST(Fabric, NormalAndTangentialStressAddUp) {
  Random random(4);
  const auto contacts = random_contacts(10, 200, random);
  const Mat3 whole = stress(contacts, 2);
  const auto parts = stress_parts(contacts, 2);
  for (std::size_t k = 0; k < 9; ++k) EXPECT_NEAR(parts.normal.a[k] + parts.tangential.a[k], whole.a[k], 1e-12);
  EXPECT_NEAR(deviator_share(parts.normal, whole, 3) + deviator_share(parts.tangential, whole, 3), 1, 1e-12);
  EXPECT_NEAR(deviator_share(0.3 * whole, whole, 3), 0.3, 1e-12);
  EXPECT_EQ(deviator_share(whole, Mat3::identity(), 3), 0);
}

TEST(ForceNetwork, StrongContactsAreThoseAboveTheMean) {
  const std::vector contacts{contact(0, 1, {0, 0, 1}, 8, {1, 0, 0}), contact(0, 2, {1, 0, 0}, 1),
                             contact(1, 2, {0, 1, 0}, 3)};
  const auto f = force_network(contacts, 3);
  EXPECT_DOUBLE_EQ(f.mean_force, 4);
  EXPECT_DOUBLE_EQ(f.largest_force, 8);
  EXPECT_DOUBLE_EQ(f.strong_contacts, 1. / 3);
  EXPECT_DOUBLE_EQ(f.strong_mean_share, 8. / 12);
  EXPECT_DOUBLE_EQ(f.mobilised_friction, 0.25 / 3);
  EXPECT_EQ(force_network({}, 3).mean_force, 0);
}

TEST(Rose, DensitiesAverageToOneAndAreSymmetric) {
  Random random(1);
  const auto contacts = random_contacts(10, 400, random);
  for (const auto& rose : {rose_2d(contacts), rose_3d(contacts, 6)}) {
    double density = 0, force = 0;
    for (const auto& p : rose) density += p.density, force += p.density * p.force;
    EXPECT_NEAR(density / static_cast<double>(rose.size()), 1, 1e-12);
    EXPECT_NEAR(force / static_cast<double>(rose.size()), 1, 1e-12);
  }
  const auto rose = rose_2d(contacts, 8);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(rose[k].density, rose[k + 4].density);
  const auto solid = rose_3d(contacts, 4);  // the patch opposite: mirrored ring, half a turn on
  for (std::size_t r = 0; r < 4; ++r)
    for (std::size_t k = 0; k < 8; ++k) EXPECT_EQ(solid[r * 8 + k].density, solid[(3 - r) * 8 + (k + 4) % 8].density);
}

TEST(Rose, IsotropicContactsFillItEvenly) {
  Random random(6);
  std::vector<ContactPoint> contacts;
  for (int k = 0; k < 40000; ++k)
    contacts.push_back(contact(0, 1, {random.normal(), random.normal(), random.normal()}, 1));
  for (const auto& p : rose_3d(contacts, 6)) EXPECT_NEAR(p.density, 1, 0.15);
  for (const auto& p : rose_2d(contacts, 12)) EXPECT_NEAR(p.density, 1, 0.08);
}

TEST(Rose, AHexagonalLatticeHasSixPetals) {
  const Scene scene = test::lattice_scene("linear", "hexagonal", {4, 4, 1}, 1e-3);
  State state = test::state_of(scene);
  rebuild_neighbours(state, 1e-4, 1e-5);
  const auto contacts = touching_contacts(scene, state);
  for (const auto& p : rose_2d(contacts, 6)) EXPECT_NEAR(p.density, 1, 1e-12);
  int petals = 0;
  for (const auto& p : rose_2d(contacts, 90)) {
    if (p.density == 0) continue;
    ++petals;
    EXPECT_NEAR(p.density, 15, 1e-12);
    EXPECT_NEAR(p.force, 1, 1e-9);
  }
  EXPECT_EQ(petals, 6);
}

TEST(Distribution, HistogramsKeepEveryValue) {
  const std::vector values{-1.0, 0.0, 0.05, 0.15, 0.95, 1.0, 7.0};
  const auto h = histogram(values, 0, 1, 10);
  EXPECT_EQ(h.below, 1u);
  EXPECT_EQ(h.above, 2u);
  EXPECT_EQ(h.count.front(), 2u);
  EXPECT_EQ(h.count.back(), 1u);
  EXPECT_EQ(h.total(), values.size());
  EXPECT_NEAR(h.density(0), 2 / (7 * 0.1), 1e-12);
  EXPECT_NEAR(h.middle(9), 0.95, 1e-12);
}

TEST(Distribution, ConnectivityAgreesWithCoordination) {
  Random random(3);
  const auto contacts = random_contacts(50, 120, random);
  const auto count = connectivity(50, contacts);
  double grains = 0, ends = 0;
  for (std::size_t c = 0; c < count.size(); ++c)
    grains += static_cast<double>(count[c]), ends += static_cast<double>(c * count[c]);
  EXPECT_EQ(grains, 50);
  EXPECT_NEAR(ends / grains, coordination(50, contacts).mean, 1e-12);
  EXPECT_TRUE(connectivity(0, {}).empty());
}

TEST(Distribution, NormalSpinsHaveKurtosisThree) {
  Random random(9);
  State state;
  for (int k = 0; k < 20000; ++k)
    state.grains.spin.push_back({5 + random.normal(), 2 * 0.5 * random.normal(), random.normal(), 1});
  state.grains.spin.push_back({1e9, 0, 0, 0});  // a fixed grain does not turn
  const Spins s = spins(state);
  EXPECT_NEAR(s.mean.x, 5, 0.03);
  EXPECT_NEAR(s.deviation, std::sqrt(3), 0.03);
  EXPECT_NEAR(s.kurtosis, 3, 0.1);
  EXPECT_NEAR(s.scaled.density(25), 0.397, 0.02);
  EXPECT_EQ(spins(State{}).deviation, 0);
}

TEST(GrainStress, GrainsTogetherGiveTheStressOfThePacking) {
  Random random(7);
  auto contacts = random_contacts(30, 150, random);
  contacts.push_back(contact(3, no_index, {0, 0, -1}, 5));
  Mat3 sum;
  for (const auto& m : grain_virials(30, contacts)) sum += m;
  const Mat3 whole = stress(contacts, 1);
  for (std::size_t k = 0; k < 9; ++k) EXPECT_NEAR(sum.a[k], whole.a[k], 1e-11);
}

State sized(std::initializer_list<double> radii) {
  State state;
  for (const double r : radii) state.grains.position.push_back({0, 0, 0, r});
  state.grains.velocity.resize(state.grains.size());
  return state;
}

TEST(GrainStress, FractionsAddUpToTheWhole) {
  Random random(11);
  State state;
  for (int k = 0; k < 60; ++k) state.grains.position.push_back({0, 0, 0, random.uniform(1, 3)});
  const auto contacts = random_contacts(60, 300, random);
  const auto splits = natural_splits(state);
  EXPECT_EQ(splits.size(), 3u);
  double stress_sum = 0, solid = 0, grains = 0, ends = 0;
  for (const auto& f : size_fractions(state, contacts, 5, splits)) {
    stress_sum += f.mean_stress_share, solid += f.solid_share, grains += static_cast<double>(f.grains);
    ends += f.coordination * static_cast<double>(f.grains);
    EXPECT_NEAR(f.solid_share, 0.25, 0.05);
  }
  EXPECT_NEAR(stress_sum, 1, 1e-12);
  EXPECT_NEAR(solid, 1, 1e-12);
  EXPECT_EQ(grains, 60);
  EXPECT_NEAR(ends / 60, coordination(60, contacts).mean, 1e-12);
  double pairs = 0;
  for (const auto& row : stress_by_pair(state, contacts, splits))
    pairs = std::accumulate(row.begin(), row.end(), pairs);
  EXPECT_NEAR(pairs, 1, 1e-12);
}

TEST(GrainStress, CoarseAndFines) {
  const State state = sized({2, 2, 0.5});
  EXPECT_EQ(natural_splits(state), std::vector{2.0});  // the middle of the gap, by ratio
  const std::vector contacts{contact(0, 1, {0, 0, 4}, 1), contact(0, 2, {2.5, 0, 0}, 0.2)};
  const auto f = size_fractions(state, contacts, 1, natural_splits(state));
  ASSERT_EQ(f.size(), 2u);
  EXPECT_NEAR(f[0].mean_stress_share, 0.5 * 0.5 / 4.5, 1e-12);  // half of its one contact
  EXPECT_NEAR(f[0].stress_ratio, f[0].mean_stress_share * (8 + 8 + 0.125) / 0.125, 1e-9);
  EXPECT_EQ(f[0].rattler_share, 1);
  const auto pair = stress_by_pair(state, contacts, natural_splits(state));
  EXPECT_NEAR(pair[0][1], 0.5 / 4.5, 1e-12);
  EXPECT_NEAR(pair[1][1], 4 / 4.5, 1e-12);
  EXPECT_TRUE(natural_splits(sized({1, 1, 1})).empty());
}

TEST(ForceChains, AColumnUnderLoadIsOneChain) {
  // four grains in a column, two to the side that carry little
  const State state = sized({1, 1, 1, 1, 1, 1});
  const std::vector contacts{contact(0, 1, {0, 0, 2}, 9),       contact(1, 2, {0, 0, 2}, 9),
                             contact(2, 3, {0, 0, 2}, 9),       contact(1, 4, {2, 0, 0}, 1),
                             contact(4, 5, {2, 0, 0}, 1),       contact(0, no_index, {0, 0, -1}, 9),
                             contact(3, no_index, {0, 0, 1}, 9)};
  const auto chains = force_chains(state, contacts);
  ASSERT_EQ(chains.length, std::vector{4});
  EXPECT_EQ(chains.chain, (std::vector{0, 0, 0, 0, -1, -1}));
  EXPECT_EQ(chains.link, (std::vector{0, 0, 0, -1, -1, -1, -1}));
  EXPECT_DOUBLE_EQ(chains.grain_share, 4. / 6);
  EXPECT_EQ(chains.mean_length, 4);
  EXPECT_TRUE(force_chains(state, {}).length.empty());
}

TEST(ForceChains, ABendBreaksIt) {
  const auto lengths = [](double bend) {
    const State state = sized({1, 1, 1, 1, 1, 1, 1, 1, 1, 1});
    const Vec3 up{0, 0, 2}, aside{2 * std::sin(bend), 0, 2 * std::cos(bend)};
    std::vector contacts{contact(0, 1, up, 9), contact(1, 2, up, 9), contact(3, 4, aside, 9), contact(4, 5, aside, 9)};
    contacts.push_back(contact(2, 3, aside, 2));  // a weak link that leaves the directions of 2 and 3 as they are
    contacts.push_back(contact(0, no_index, -0.5 * up, 9));
    contacts.push_back(contact(5, no_index, 0.5 * aside, 9));
    for (const Index i : {6u, 8u}) contacts.push_back(contact(i, i + 1, up, 1e-6));  // the mean is low
    return force_chains(state, contacts, 0.5).length;
  };
  EXPECT_EQ(lengths(0.3), std::vector{6});
  EXPECT_EQ(lengths(0.9), (std::vector{3, 3}));
}

}  // namespace
}  // namespace eg
