// Check values of contact laws, and the same law run with double, Batch and Dual numbers.
#include <gtest/gtest.h>

#include "base/random.hpp"
#include "contact/interaction.hpp"
#include "contact/lanes.hpp"
#include "contact/laws.hpp"
#include "support/scenes.hpp"

using namespace eg;

namespace {

Material both() {  // has the constants of every law
  Material m = test::any_material();
  m.friction = 0.3;
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

TEST(Linear, IncrementalSpringForgetsAllButTheLastStep) {
  const auto c = LinearIncremental::constants(both(), both(), 3);
  const auto p = LinearIncremental::pair<double>(c, grain_sizes(1e-3, 1e-3));
  ContactHistory<LinearIncremental, double> h{};
  LinearIncremental::respond<double>(p, {1e-6, {1e-8, 0, 0}}, h);
  const auto r = LinearIncremental::respond<double>(p, {1e-6, {0, 2e-8, 0}}, h);
  EXPECT_EQ(r.shear.x, 0);
  EXPECT_DOUBLE_EQ(r.shear.y, 7e5 * 2e-8);
}

TEST(HertzExponent, OneAndAHalfIsHertzMindlin) {
  Material m = both();
  m.hertz_exponent = 1.5;
  const auto p = HertzExponent::pair<double>(HertzExponent::constants(m, m, 3), grain_sizes(1e-3, 2e-3));
  const auto q = HertzMindlin::pair<double>(HertzMindlin::constants(m, m, 3), grain_sizes(1e-3, 2e-3));
  for (const double overlap : {1e-8, 1e-6, 1e-5}) {
    const auto a = HertzExponent::normal<double>(p, overlap), b = HertzMindlin::normal<double>(q, overlap);
    EXPECT_NEAR(a.force, b.force, 1e-13 * b.force);
    EXPECT_NEAR(a.stiffness, b.stiffness, 1e-13 * b.stiffness);
    EXPECT_NEAR(a.tangential, b.tangential, 1e-13 * b.tangential);
  }
  m.hertz_exponent = 1.7;  // PFC's own form: h = 2G√(2R̄)/(3(1 − ν)), ks by h^(1/α) N^((α−1)/α)
  const auto r = HertzExponent::pair<double>(HertzExponent::constants(m, m, 3), grain_sizes(1e-3, 2e-3));
  const double mean = 2 * 1e-3 * 2e-3 / 3e-3, h = 2 * 29e9 * std::sqrt(2 * mean) / (3 * (1 - 0.12));
  const auto n = HertzExponent::normal<double>(r, 1e-6);
  EXPECT_NEAR(n.force / (h * std::pow(1e-6, 1.7)), 1, 1e-13);
  const double ks = 2 * (1 - 0.12) / (2 - 0.12) * 1.7 * std::pow(h, 1 / 1.7) * std::pow(n.force, 0.7 / 1.7);
  EXPECT_NEAR(n.tangential / ks, 1, 1e-13);
}

TEST(RoughHertzMindlin, IsContinuousWithItsStiffnessAtBothThresholds) {
  const auto p =
      RoughHertzMindlin::pair<double>(RoughHertzMindlin::constants(both(), both(), 3), grain_sizes(1e-3, 1.5e-3));
  const double s = std::numbers::sqrt2 * both().roughness;
  EXPECT_NEAR(p.s, s, 1e-12 * s);
  for (const double end : {rough::end1, rough::end2}) {
    const auto below = RoughHertzMindlin::normal<double>(p, end * s * (1 - 1e-12));
    const auto above = RoughHertzMindlin::normal<double>(p, end * s * (1 + 1e-12));
    EXPECT_NEAR(below.force / above.force, 1, 1e-10);
    EXPECT_NEAR(below.stiffness / above.stiffness, 1, 1e-10);
    EXPECT_NEAR(RoughHertzMindlin::normal_energy(p, end * s * (1 - 1e-12)) /
                    RoughHertzMindlin::normal_energy(p, end * s * (1 + 1e-12)),
                1, 1e-10);
  }
  const double e_star = 29e9 / (1 - 0.12), r_star = 0.6e-3, n1 = s * e_star * std::sqrt(2 * r_star * s);
  EXPECT_NEAR(RoughHertzMindlin::normal<double>(p, rough::end1 * s).force / n1, 1, 1e-12);
  EXPECT_NEAR(RoughHertzMindlin::normal<double>(p, rough::end2 * s).force / (100 * n1), 1, 1e-12);
  const double deep = 60 * s, hertz = 4. / 3 * e_star * std::sqrt(r_star) * std::pow(deep - 2.06 * s, 1.5);
  const auto n = RoughHertzMindlin::normal<double>(p, deep);
  EXPECT_NEAR(n.force / hertz, 1, 1e-13);
  EXPECT_NEAR(n.tangential / n.stiffness, 2 * (1 - 0.12) / (2 - 0.12), 1e-14);
}

TEST(RoughHertzMindlin, WithoutRoughnessIsSmooth) {
  Material m = both();
  m.roughness = 0;
  const auto p = RoughHertzMindlin::pair<double>(RoughHertzMindlin::constants(m, m, 3), grain_sizes(1e-3, 2e-3));
  const auto q = HertzMindlin::pair<double>(HertzMindlin::constants(m, m, 3), grain_sizes(1e-3, 2e-3));
  for (const double overlap : {1e-9, 1e-6}) {
    const auto a = RoughHertzMindlin::normal<double>(p, overlap), b = HertzMindlin::normal<double>(q, overlap);
    EXPECT_NEAR(a.force / b.force, 1, 1e-10);
    EXPECT_NEAR(a.stiffness / b.stiffness, 1, 1e-10);
    EXPECT_NEAR(RoughHertzMindlin::normal_energy(p, overlap) / HertzMindlin::normal_energy(q, overlap), 1, 1e-10);
  }
}

TEST(LinearRolling, CheckValues) {
  Material m = both();
  m.normal_stiffness = m.shear_stiffness = Material::unset;
  m.effective_modulus = 150e6, m.stiffness_ratio = 4, m.rolling_friction = 0.1;
  const auto p = LinearRolling::pair<double>(LinearRolling::constants(m, m, 3), grain_sizes(2.5e-3, 2.5e-3));
  EXPECT_NEAR(p.kn, 589048.62, 0.01);
  ContactHistory<LinearRolling, double> h{};
  const double overlap = 10 / p.kn, turn = 1e-4;
  auto r = LinearRolling::respond<double>(p, {overlap, {}, {turn, 0, 0}}, h);
  EXPECT_NEAR(r.couple.x / turn, 0.2300971, 1e-7);
  EXPECT_NEAR(LinearRolling::at_rest(p, overlap, h).rolling, 0.2300971, 1e-7);
  EXPECT_NEAR(r.work, 0.5 * 0.2300971 * turn * turn, 1e-15);
  EXPECT_EQ(r.loss, 0);
  for (int k = 0; k < 2000; ++k) r = LinearRolling::respond<double>(p, {overlap, {}, {turn, 0, 0}}, h);
  EXPECT_NEAR(r.couple.x, 1.25e-3, 1e-15);
  EXPECT_NEAR(r.loss, 1.25e-3 * turn, 1e-15);
  EXPECT_NEAR(LinearRolling::pair<double>(LinearRolling::constants(m, m, 3), wall_sizes(2.5e-3)).radius, 2.5e-3, 1e-18);
}

LinearParallelBond::Pair<double> bond_pair() {
  return LinearParallelBond::pair<double>(LinearParallelBond::constants(both(), both(), 3), grain_sizes(1e-3, 1e-3));
}

TEST(LinearParallelBond, CheckValues) {
  const auto p = bond_pair();
  EXPECT_NEAR(p.axial, 1.570796e6, 1);
  EXPECT_NEAR(p.across, 7.853982e5, 0.1);
  EXPECT_NEAR(p.bending, 0.3926991, 1e-7);
  EXPECT_NEAR(p.twisting, 0.3926991, 1e-7);
  ContactHistory<LinearParallelBond, double> h{};
  LinearParallelBond::bond(h, -1e-6);
  const Standing s = LinearParallelBond::at_rest(p, -2e-6, h);
  EXPECT_TRUE(s.bonded);
  EXPECT_NEAR(s.normal.force, -p.axial * 1e-6, 1e-9);
  EXPECT_EQ(s.normal.stiffness, p.axial);
  EXPECT_EQ(s.rolling, p.bending);
  EXPECT_NEAR(LinearParallelBond::at_rest(p, 2e-6, h).normal.stiffness, p.axial + p.kn, 1e-6);
}

/// Largest load of a bond that is moved step by step until it breaks, how it broke, and the energy it cost.
struct Break {
  double load = 0, pulled = 0, cut = 0, work = 0, loss = 0;
};
template <class Load>
Break break_bond(double opening, const Strain<double>& step, Load load) {
  const auto p = bond_pair();
  ContactHistory<LinearParallelBond, double> h{};
  LinearParallelBond::bond(h, -1e-6);
  Break b;
  Strain<double> strain = step;
  strain.opening = -1e-6;
  for (int k = 0; k < 100000 && h[LinearParallelBond::bond_value] > 0; ++k) {
    strain.opening += opening;
    const auto r = LinearParallelBond::respond<double>(p, strain, h);
    b.load = std::max(b.load, load(r)), b.pulled += r.pulled, b.cut += r.cut, b.work += r.work, b.loss += r.loss;
  }
  const auto after = LinearParallelBond::respond<double>(p, strain, h);
  EXPECT_EQ(after.normal.force, 0);
  EXPECT_EQ(norm(after.shear) + norm(after.couple) + std::abs(after.torsion), 0);
  return b;
}

TEST(LinearParallelBond, BreaksAtItsStrength) {
  using R = Response<double>;
  const double area = std::numbers::pi * 1e-6, inertia = area * 1e-6 / 4, sigma = 2e6, tau = 3e6, beta = 0.5;
  const auto p = bond_pair();
  const Break tension = break_bond(-1e-10, {0, {}}, [](const R& r) { return -r.normal.force; });
  EXPECT_NEAR(tension.load / (sigma * area), 1, 1e-4);
  EXPECT_EQ(tension.pulled, 1);
  EXPECT_NEAR(tension.loss / (0.5 * tension.load * tension.load / p.axial), 1, 1e-3);
  const Break shear = break_bond(0, {0, {0, 1e-9, 0}}, [](const R& r) { return norm(r.shear); });
  EXPECT_NEAR(shear.load / (tau * area), 1, 1e-3);
  EXPECT_EQ(shear.cut, 1);
  EXPECT_NEAR(shear.loss / (0.5 * shear.load * shear.load / p.across), 1, 1e-2);
  EXPECT_NEAR(shear.work / shear.loss, 1, 1e-2);  // all of it is lost
  const Break bending = break_bond(0, {0, {}, {0, 0, 1e-6}}, [](const R& r) { return norm(r.couple); });
  EXPECT_NEAR(bending.load / (sigma * inertia / (beta * 1e-3)), 1, 1e-3);
  EXPECT_EQ(bending.pulled, 1);
  const Break twist = break_bond(0, {0, {}, {}, -1e-6}, [](const R& r) { return std::abs(r.torsion); });
  EXPECT_NEAR(twist.load / (tau * 2 * inertia / (beta * 1e-3)), 1, 1e-3);
  EXPECT_EQ(twist.cut, 1);
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
    Law::template respond<double>(pair, {1.01 * overlap, {}}, s.history);  // the contact is unloading
    set_history_vector(s.history, 0, t);
    if constexpr (HasBonds<Law>)
      if (random.uniform() < 0.5) Law::bond(s.history, overlap + random.uniform(-1e-7, 1e-7));
    if constexpr (HasCouples<Law>) {
      const Vec3 m = cross(n, vec(1e-5));
      set_history_vector(s.history, Law::history_vectors - 1, m);
    }
  }
  return s;
}

/// In number type S; duals take the derivatives from number `first` on (12: none).
template <class S>
Vec<S> lift(const Vec3& v, std::size_t first = 12) {
  Vec<S> lifted{S(v.x), S(v.y), S(v.z)};
  if constexpr (std::is_same_v<S, Dual<12>>)
    for (std::size_t k = 0; k < 3 && first < 12; ++k) lifted[static_cast<int>(k)].d[first + k] = 1;
  return lifted;
}

/// Forces and moments (fx fy fz, mi, mj) and the new history of one sample in number type S; all lanes alike.
template <class Law, class S>
std::vector<S> forces(const Sample<Law>& s) {
  const auto table = Law::constants(both(), both(), 3);
  const auto c = broadcast_struct<typename Law::template Constants<S>, S>(table);
  const Vec<S> ui = lift<S>(s.ui, 0), ti = lift<S>(s.ti, 3), uj = lift<S>(s.uj, 6), tj = lift<S>(s.tj, 9);
  const Vec<S> branch = lift<S>(s.branch) + (uj - lift<S>(s.uj)) - (ui - lift<S>(s.ui));  // moves with the grains
  const auto g = grain_grain<S>(branch, S(s.ri), S(s.ri) + S(s.rj), Arms::middle);
  const auto inc = increment<true>(g, motion_of<S>(uj - ui, ti, S(s.ri), tj, S(s.rj)));
  ContactHistory<Law, S> h;
  for (std::size_t k = 0; k < h.size(); ++k) h[k] = S(s.history[k]);
  const auto f = interact<Law, false>(Law::template pair<S>(c, grain_sizes(S(s.ri), S(s.rj))), g, inc,
                                      g.overlap > S(0.0), h, Dashpot<S>{});
  std::vector<S> out{f.on_j.x, f.on_j.y, f.on_j.z};
  if constexpr (Law::history_vectors > 0)
    for (const auto& m : {f.moment * g.arm_i + f.couple, f.moment * g.arm_j - f.couple})
      out.insert(out.end(), {m.x, m.y, m.z});
  out.insert(out.end(), h.begin(), h.end());
  return out;
}

template <class Law>
class EveryLaw : public ::testing::Test {};
/// Every law of the list, with and without friction.
template <class List>
struct WithFrictionless;
template <class... L>
struct WithFrictionless<std::tuple<L...>> {
  using type = ::testing::Types<L..., Frictionless<L>...>;
};
using Tested = WithFrictionless<Laws>::type;
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

/// Forces and moments by finite differences against duals, at increments away from the kinks of the laws.
TYPED_TEST(EveryLaw, TangentIsTheDerivativeOfTheForces) {
  Random random(6);
  const std::size_t forces_only = TypeParam::history_vectors > 0 ? 9 : 3;
  int checked = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const auto s = sample<TypeParam>(random, trial % 2 ? 1e-9 : 1e-7, trial % 3 ? 0.9 : 0.3);
    const auto exact = forces<TypeParam, Dual<12>>(s);
    const auto plain = forces<TypeParam, double>(s);
    for (std::size_t c = 0; c < 12; ++c) {
      const bool turns = c % 6 >= 3;
      const double h = turns ? 1e-9 : 1e-12;
      const auto moved = [&](double by) {
        auto t = s;
        Vec3& v = c < 3 ? t.ui : c < 6 ? t.ti : c < 9 ? t.uj : t.tj;
        v[static_cast<int>(c % 3)] += by;
        if (!turns) t.branch[static_cast<int>(c % 3)] += c < 3 ? -by : by;
        return forces<TypeParam, double>(t);
      };
      const auto up = moved(h), down = moved(-h);
      for (std::size_t r = 0; r < forces_only; ++r) {
        const double unit = (r < 3 ? 1 : 1e3) * (turns ? 1e3 : 1);  // moments and turns count at a radius of 1 mm
        const double forward = (up[r] - plain[r]) / h * unit, backward = (plain[r] - down[r]) / h * unit;
        if (std::abs(forward - backward) > 3e2) continue;  // a kink between the two
        EXPECT_NEAR((forward + backward) / 2, exact[r].d[c] * unit, 3e2) << r << " by " << c << " trial " << trial;
        ++checked;
      }
    }
  }
  EXPECT_GT(checked, static_cast<int>(forces_only) * 12 * 80);
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
    if constexpr (TypeParam::history_vectors > 0 && !HasBonds<TypeParam>) {
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
    EXPECT_NEAR(quotient(Batch(3.0), Batch(a))[3] * a, 3, 15e-16);
    EXPECT_NEAR(root(Batch(a))[3] / std::sqrt(a), 1, 7e-16);
  }
  EXPECT_EQ(root(Batch(0.0))[0], 0.0);
}

TEST(Batch, PowersAreAccurate) {
  Random random(11);
  for (int trial = 0; trial < 2000; ++trial) {
    const double a = std::exp(random.uniform(-60, 60)), p = random.uniform(-3, 3);
    EXPECT_NEAR(binary_logarithm(Batch(a))[2], std::log2(a), 4e-16 * std::max(1.0, std::abs(std::log2(a))));
    EXPECT_NEAR(binary_power(Batch(p), Batch(1.0))[1] / std::exp2(p), 1, 6e-16);
    EXPECT_NEAR(power(Batch(a), Batch(p))[6] / std::pow(a, p), 1, 4e-16 * (2 + std::abs(p * std::log(a))));
  }
  EXPECT_EQ(power(Batch(1.0), Batch(0.3))[0], 1.0);
}

TEST(Batch, CubeRootsAreAccurate) {
  Random random(11);
  for (int trial = 0; trial < 2000; ++trial) {
    const double a = std::exp(random.uniform(-60, 60));
    EXPECT_NEAR(inverse_cube_root(Batch(a))[5] * std::cbrt(a), 1, 1e-15);
  }
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
