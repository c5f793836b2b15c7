// Check values of contact laws, and the same law run with double, Batch and Dual numbers.
#include <gtest/gtest.h>

#include "base/random.hpp"
#include "contact/interaction.hpp"
#include "contact/lanes.hpp"
#include "contact/laws.hpp"

using namespace eg;

namespace {

Material both() {  // has the constants of every law
  Material m;
  m.shear_modulus = 29e9, m.poisson = 0.12, m.friction = 0.3;
  m.normal_stiffness = 1e6, m.shear_stiffness = 7e5;
  return m;
}

TEST(Linear, DeformabilityGivesPublishedStiffness) {
  Material m;
  m.effective_modulus = 145e6, m.stiffness_ratio = 1.75;
  const auto c = Linear::constants(m, m, 3);
  const auto equal = Linear::pair<double>(c, grain_sizes(2.5e-3, 2.5e-3));
  EXPECT_NEAR(equal.kn, 569413.67, 0.01);
  EXPECT_NEAR(equal.ks, 325379.24, 0.01);
  EXPECT_NEAR(Linear::pair<double>(c, grain_sizes(2e-3, 4e-3)).kn, 303687.29, 0.01);
  const auto wall = Linear::pair<double>(c, wall_sizes(2.5e-3));
  EXPECT_NEAR(wall.kn, 2 * equal.kn, 1e-6 * equal.kn);  // L = R instead of 2R
}

TEST(HertzMindlin, CheckValues) {
  const auto c = HertzMindlin::constants(both(), both(), 3);
  const auto p = HertzMindlin::pair<double>(c, grain_sizes(1e-3, 1e-3));
  const auto n = HertzMindlin::normal<double>(p, 1e-6);
  EXPECT_NEAR(n.force, 0.98251472, 1e-8);
  EXPECT_NEAR(n.stiffness, 1473772.08, 0.01);
  EXPECT_NEAR(n.tangential, 1379701.52, 0.01);
  EXPECT_NEAR(wall_sizes(1e-3).r_star(), 1e-3, 1e-18);
}

TEST(HertzMindlin, RescalingShortensShearOnUnloadingOnly) {
  const auto p =
      HertzMindlinRescale::pair<double>(HertzMindlinRescale::constants(both(), both(), 3), grain_sizes(1e-3, 1e-3));
  ContactHistory<HertzMindlinRescale, double> h{};
  const Vec3 zero{};
  HertzMindlinRescale::respond<double>(p, {1e-6, {1e-8, 0, 0}}, h);
  const double t = h[0];
  HertzMindlinRescale::respond<double>(p, {2e-6, zero}, h);
  EXPECT_DOUBLE_EQ(h[0], t);
  HertzMindlinRescale::respond<double>(p, {0.5e-6, zero}, h);
  EXPECT_NEAR(h[0], t * 0.5, 1e-12 * t);  // √(0.5/2)
}

template <class Law>
struct Sample {
  Vec3 branch, ui, uj, ti, tj;
  double ri, rj;
  ContactHistory<Law, double> history{};
};

template <class Law>
Sample<Law> sample(Random& random, double slip, double preload) {
  Sample<Law> s;
  s.ri = random.uniform(0.5e-3, 2e-3), s.rj = random.uniform(0.5e-3, 2e-3);
  Vec3 n{random.normal(), random.normal(), random.normal()};
  n *= 1 / norm(n);
  const double overlap = random.uniform(0.2e-6, 3e-6);
  s.branch = n * (s.ri + s.rj - overlap);
  const auto vec = [&](double scale) {
    return Vec3{random.normal() * scale, random.normal() * scale, random.normal() * scale};
  };
  s.ui = vec(slip), s.uj = vec(slip), s.ti = vec(slip / 1e-3), s.tj = vec(slip / 1e-3);
  if constexpr (Law::history_vectors > 0) {
    const auto pair = Law::template pair<double>(Law::constants(both(), both(), 3), grain_sizes(s.ri, s.rj));
    Vec3 t = cross(n, vec(1));
    t *= preload * pair.friction * Law::template normal<double>(pair, overlap).force / norm(t);
    set_history_vector(s.history, 0, t);
  }
  if constexpr (Law::history_scalars > 0) s.history[3] = 1e9;  // a larger contact radius than any: unloading
  return s;
}

template <class S>
Vec<S> lift(const Vec3& v) {
  return {S(v.x), S(v.y), S(v.z)};
}

/// Forces and moments (fx fy fz, mi, mj) and the new history of one sample in number type S; all lanes alike.
template <class Law, class S>
std::vector<S> forces(const Sample<Law>& s) {
  const auto table = Law::constants(both(), both(), 3);
  const auto c = broadcast_struct<typename Law::template Constants<S>, S>(table);
  const auto g = grain_grain<S>(lift<S>(s.branch), S(s.ri), S(s.ri) + S(s.rj), Arms::middle);
  const auto inc =
      increment<true>(g, motion_of<S>(lift<S>(s.uj - s.ui), lift<S>(s.ti), S(s.ri), lift<S>(s.tj), S(s.rj)));
  ContactHistory<Law, S> h;
  for (std::size_t k = 0; k < h.size(); ++k) h[k] = S(s.history[k]);
  const auto f = interact<Law, false>(Law::template pair<S>(c, grain_sizes(S(s.ri), S(s.rj))), g, inc,
                                      g.overlap > S(0.0), h, Dashpot<S>{});
  std::vector<S> out{f.on_j.x, f.on_j.y, f.on_j.z};
  if constexpr (Law::history_vectors > 0)
    for (const auto& m : {f.moment * g.arm_i, f.moment * g.arm_j}) out.insert(out.end(), {m.x, m.y, m.z});
  out.insert(out.end(), h.begin(), h.end());
  return out;
}

template <class Law>
class EveryLaw : public ::testing::Test {};
using Tested =
    ::testing::Types<Linear, HertzMindlin, HertzMindlinRescale, Frictionless<Linear>, Frictionless<HertzMindlin>>;
TYPED_TEST_SUITE(EveryLaw, Tested);

TYPED_TEST(EveryLaw, SameForcesInEveryNumberType) {
  Random random(3);
  for (int trial = 0; trial < 400; ++trial) {
    const auto s = sample<TypeParam>(random, trial % 2 ? 1e-9 : 1e-6, trial % 3 ? 0.9 : 0.0);  // sticking and sliding
    const auto d = forces<TypeParam, double>(s);
    const auto b = forces<TypeParam, Batch>(s);
    const auto a = forces<TypeParam, Dual<12>>(s);
    double scale = 0;  // the overlap is a small difference of lengths: its round-off is that of the radii
    for (const double v : d) scale = std::max(scale, std::abs(v));
    scale *= 8 * 2.2e-16 * (s.ri + s.rj) / (s.ri + s.rj - norm(s.branch));
    for (std::size_t k = 0; k < d.size(); ++k) {
      EXPECT_NEAR(b[k][5], d[k], scale);
      EXPECT_NEAR(a[k].v, d[k], scale);
    }
  }
}

TYPED_TEST(EveryLaw, StiffnessesAreDerivatives) {
  const auto p = TypeParam::template pair<double>(TypeParam::constants(both(), both(), 3), grain_sizes(1e-3, 2e-3));
  for (const double overlap : {1e-9, 1e-7, 1e-6, 1e-5}) {
    const double h = 1e-4 * overlap;
    const auto n = TypeParam::template normal<double>(p, overlap);
    const double up = TypeParam::template normal<double>(p, overlap + h).force,
                 down = TypeParam::template normal<double>(p, overlap - h).force;
    EXPECT_NEAR(n.stiffness, (up - down) / (2 * h), 1e-7 * n.stiffness);
    EXPECT_NEAR((TypeParam::normal_energy(p, overlap + h) - TypeParam::normal_energy(p, overlap - h)) / (2 * h),
                n.force, 1e-7 * n.force);
    EXPECT_EQ(TypeParam::template normal<double>(p, 0).force, 0);
  }
}

TYPED_TEST(EveryLaw, CoulombHoldsAndHistoryLiesInThePlane) {
  Random random(4);
  for (int trial = 0; trial < 200; ++trial) {
    const auto s = sample<TypeParam>(random, 1e-6, 0.9);
    const auto out = forces<TypeParam, double>(s);
    if constexpr (TypeParam::history_vectors > 0) {
      const Vec3 n = s.branch * (1 / norm(s.branch)), t{out[9], out[10], out[11]};
      const Vec3 f{out[0], out[1], out[2]};
      EXPECT_LE(norm(t), 0.3 * dot(f, n) * (1 + 1e-12));
      EXPECT_NEAR(dot(t, n), 0, 1e-9 * norm(t));
    }
  }
}

TEST(Contact, StoredShearKeepsItsLengthAndTurnsWithTheBody) {
  const Vec3 n{0, 0, 1}, t{3, 4, 0};
  const double angle = 1e-3;
  const Vec3 tilted{std::sin(angle), 0, std::cos(angle)};
  const Vec3 turned = turn(t, tilted, 0.0);
  EXPECT_NEAR(norm(turned), 5, 1e-14);
  EXPECT_NEAR(dot(turned, tilted), 0, 1e-14);
  const Vec3 spun = turn(t, n, angle);
  EXPECT_NEAR(spun.x, 3 * std::cos(angle) - 4 * std::sin(angle), 1e-8);
  EXPECT_NEAR(spun.y, 4 * std::cos(angle) + 3 * std::sin(angle), 1e-8);
}

TEST(Batch, LoadsOfBothSidesEqualTheScalarOnes) {
  Random random(8);
  std::array<Quad, 12> position, velocity, spin, shift;
  for (auto* set : {&position, &velocity, &spin, &shift})
    for (auto& q : *set) q = {random.normal(), random.normal(), random.normal(), set == &shift ? 0 : random.uniform()};
  const std::array<Index, 8> i{0, 0, 1, 2, 2, 2, 3, 3}, j{4, 5, 2, 7, 8, 9, 3, 11};
  const std::array<std::uint8_t, 8> image{0, 1, 2, 3, 4, 5, 6, 7};
  BothSides<Batch> all;
  load_sides<true, Batch>(all, position.data(), velocity.data(), spin.data(), i.data(), j.data(), shift.data(),
                          image.data());
  for (std::size_t k = 0; k < 8; ++k) {
    BothSides<double> one;
    load_sides<true, double>(one, position.data(), velocity.data(), spin.data(), &i[k], &j[k], shift.data(), &image[k]);
    EXPECT_NEAR(all.branch.x[k], one.branch.x, 1e-14);
    EXPECT_NEAR(all.branch.w[k], one.branch.w, 1e-14);
    EXPECT_NEAR(all.velocity.y[k], one.velocity.y, 1e-14);
    EXPECT_EQ(all.spin_i.z[k], one.spin_i.z);
    EXPECT_EQ(all.spin_j.w[k], one.spin_j.w);
    EXPECT_EQ(all.radius_i[k], position[i[k]].w);
  }
}

TEST(Batch, ContactsAddUpOnOneGrainInSeveralLanes) {
  const std::array<Index, 8> i{0, 0, 0, 1, 1, 2, 3, 3}, j{1, 2, 3, 2, 4, 4, 4, 5};
  Random random(9);
  Vec<Batch> f, m;
  Batch ai, aj;
  for (auto* v : {&f.x, &f.y, &f.z, &m.x, &m.y, &m.z, &ai, &aj})
    for (int k = 0; k < 8; ++k) v->v[k] = random.normal();
  std::array<Quad, 12> batch{}, scalar{};
  add_contact<2, Batch>(batch.data(), i.data(), j.data(), f, m, lanes_at(ai), lanes_at(aj));
  for (std::size_t k = 0; k < 8; ++k)
    add_contact<2, double>(scalar.data(), &i[k], &j[k], {f.x[k], f.y[k], f.z[k]}, {m.x[k], m.y[k], m.z[k]},
                           lanes_at(ai) + k, lanes_at(aj) + k);
  for (std::size_t q = 0; q < 12; ++q) {
    EXPECT_NEAR(batch[q].x, scalar[q].x, 1e-14);
    EXPECT_NEAR(batch[q].y, scalar[q].y, 1e-14);
    EXPECT_NEAR(batch[q].z, scalar[q].z, 1e-14);
  }
}

TEST(Batch, FastRootsAreAccurate) {
  Random random(10);
  for (int trial = 0; trial < 1000; ++trial) {
    const double a = std::exp(random.uniform(-60, 60));
    EXPECT_NEAR(rsqrt(Batch(a))[3] * std::sqrt(a), 1, 5e-16);
    EXPECT_NEAR(reciprocal(Batch(a))[3] * a, 1, 5e-16);
    EXPECT_NEAR(root(Batch(a))[3] / std::sqrt(a), 1, 7e-16);
  }
  EXPECT_EQ(root(Batch(0.0))[0], 0.0);
}

TEST(Batch, SelectAndMasksWork) {  // clang 14 with std::experimental::simd silently fails this kind of test
  Batch a(1.0), b(2.0);
  a.v[3] = 5.0;
  const Batch c = select(a > b, a, Batch(0.0));
  for (std::size_t k = 0; k < 8; ++k) EXPECT_EQ(c[k], k == 3 ? 5.0 : 0.0);
  EXPECT_TRUE(any(a > b));
  EXPECT_FALSE(any((a > b) & (a < b)));
  EXPECT_EQ(sum(max(a, b)), 2 * 7 + 5.0);
  EXPECT_EQ(sqrt(Batch(4.0))[7], 2.0);
}

}  // namespace
