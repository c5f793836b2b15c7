// Hertz–Mindlin–Deresiewicz against closed forms: monotonic curve, loop energy, changing normal force, any direction.
#include <gtest/gtest.h>

#include <cmath>

#include "contact/laws.hpp"
#include "support/scenes.hpp"

using namespace eg;

namespace {

constexpr double shear_modulus = 29e9, poisson = 0.12, friction = 0.3;

/// One contact of two spheres of 1 mm, moved step by step.
template <class Law>
class Contact {
 public:
  Contact() {
    Material m = test::any_material();
    m.friction = friction;
    pair_ = Law::template pair<double>(Law::constants(m, m, 3), grain_sizes(1e-3, 1e-3));
  }
  /// Overlap goes to `overlap` while j slips by `slip`, in `steps` equal steps.
  void move(double overlap, const Vec3& slip, int steps = 1) {
    const double from = overlap_;
    for (int k = 1; k <= steps; ++k) {
      overlap_ = from + (overlap - from) * k / steps;
      const Vec3 before = shear(), part = slip * (1.0 / steps);
      const auto r = Law::template respond<double>(pair_, {overlap_, part}, history_);
      work += dot(before + r.shear, part) / 2, loss += r.loss;
    }
  }
  void slip(double x, double y = 0, int steps = 1) { move(overlap_, {x, y, 0}, steps); }

  Vec3 shear() const { return history_vector(history_, 0); }
  double limit() const { return friction * normal().force; }
  double stiffness() const { return normal().tangential; }
  NormalResponse<double> normal() const { return Law::template normal<double>(pair_, overlap_); }
  double work = 0, loss = 0;

 private:
  typename Law::template Pair<double> pair_;
  ContactHistory<Law, double> history_{};
  double overlap_ = 0;
};

using PartialSlipContact = Contact<HertzMindlinPartialSlip>;

/// Slip at which the whole contact slides, 3(2 − ν)µN/(8Ga) = 3µN/(2 k0).
template <class C>
double sliding_slip(const C& c) {
  return 1.5 * c.limit() / c.stiffness();
}

TEST(PartialSlip, MonotonicCurveAtConstantNormalForce) {
  for (const int presses : {1, 200})
    for (const int steps : {1, 50}) {
      PartialSlipContact c;
      c.move(1e-6, {}, presses);
      const double a = std::sqrt(0.5e-3 * 1e-6), n = c.normal().force;
      const double s = 3 * (2 - poisson) * friction * n / (8 * shear_modulus * a);
      EXPECT_NEAR(sliding_slip(c) / s, 1, 1e-12);
      for (const double x : {.25, .5, .75}) {
        c.slip(0.25 * s, 0, steps);
        EXPECT_NEAR(c.shear().x / (friction * n), 1 - std::pow(1 - x, 1.5), 1e-9) << presses << " " << steps;
      }
      c.slip(0.3 * s, 0, steps);
      EXPECT_NEAR(c.shear().x, friction * n, 1e-12 * n);  // the whole of it slides
    }
}

TEST(PartialSlip, TangentIsTheRootOfTheRemainingSlip) {
  PartialSlipContact c;
  c.move(1e-6, {});
  const double s = sliding_slip(c), k0 = c.stiffness();
  for (const double x : {.25, .5, .75}) {
    c.slip(0.25 * s - 1e-5 * s);
    const double before = c.shear().x;
    c.slip(1e-5 * s);
    EXPECT_NEAR((c.shear().x - before) / (1e-5 * s) / k0, std::sqrt(1 - x), 2e-5);
  }
}

/// Energy lost in a loop between ±t µN (Mindlin and Deresiewicz 1953).
double loop_energy(double t, double n, double a) {
  return 9 * (2 - poisson) * friction * friction * n * n / (5 * shear_modulus * a) *
         (1 - std::pow(1 - t, 5. / 3) - 5 * t / 6 * (1 + std::pow(1 - t, 2. / 3)));
}

TEST(PartialSlip, ClosedLoopLosesTheEnergyOfTheTheory) {
  for (const double x : {0.2, 0.5, 0.8}) {
    PartialSlipContact c;
    c.move(1e-6, {});
    const double s = sliding_slip(c), n = c.normal().force, a = std::sqrt(0.5e-3 * 1e-6);
    const int steps = 4000;
    c.slip(x * s, 0, steps);
    const double t = c.shear().x / (friction * n), loaded = c.work;
    const double top = c.shear().x;
    c.loss = 0;
    c.slip(-2 * x * s, 0, 2 * steps);
    EXPECT_NEAR(c.shear().x, -top, 2e-3 * top);
    c.slip(2 * x * s, 0, 2 * steps);
    EXPECT_NEAR(c.shear().x, top, 2e-3 * top);
    EXPECT_NEAR((c.work - loaded) / loop_energy(t, n, a), 1, 2e-3) << x;
    EXPECT_NEAR(c.loss / loop_energy(t, n, a), 1, 2e-3) << x;
  }
}

TEST(PartialSlip, ReloadingReturnsToTheFirstCurve) {
  PartialSlipContact c, straight;
  c.move(1e-6, {}), straight.move(1e-6, {});
  const double s = sliding_slip(c);
  c.slip(0.4 * s, 0, 400), c.slip(-0.2 * s, 0, 200), c.slip(0.2 * s, 0, 200), c.slip(0.3 * s, 0, 300);
  straight.slip(0.7 * s);
  EXPECT_NEAR(c.shear().x / straight.shear().x, 1, 1e-3);
}

TEST(PartialSlip, UnloadingIsTheDoubledCurve) {
  PartialSlipContact c;
  c.move(1e-6, {});
  const double s = sliding_slip(c), limit = c.limit();
  c.slip(0.6 * s);
  const double top = c.shear().x;
  c.slip(-0.5 * s);
  EXPECT_NEAR(top - c.shear().x, 2 * limit * (1 - std::pow(1 - 0.25, 1.5)), 1e-9 * limit);
}

TEST(PartialSlip, GrowingNormalForceSticksAsLongAsItOutrunsTheShear) {
  PartialSlipContact c;
  double sum = 0;
  for (int k = 1; k <= 1000; ++k) {  // k0 Δs stays below µ ΔN
    const double before = c.normal().force;
    const Vec3 old = c.shear();
    PartialSlipContact next = c;
    next.move(1e-9 * k, {});
    const double ds = 0.7 * friction * (next.normal().force - before) / next.stiffness();
    c.move(1e-9 * k, {ds, 0, 0});
    sum += next.stiffness() * ds;
    ASSERT_NEAR(c.shear().x, sum, 1e-9 * sum) << k << " from " << old.x;
  }
}

TEST(PartialSlip, FallingNormalForceTakesShearFromTheSlippingRing) {
  PartialSlipContact c;
  c.move(1e-6, {});
  c.slip(0.6 * sliding_slip(c));
  const double t = c.shear().x, n = c.normal().force;
  c.move(1e-6 * (1 - 1e-5), {});
  const double dn = n - c.normal().force;
  const double theta = std::cbrt(1 - (t - friction * dn) / (friction * c.normal().force));
  EXPECT_NEAR((t - c.shear().x) / (friction * (1 - theta) * dn), 1, 1e-3);
  c.move(1e-12, {});
  EXPECT_LE(norm(c.shear()), c.limit() * (1 + 1e-12));
}

TEST(PartialSlip, AnyDirectionAndAnyPathStayWithinCoulombsLimit) {
  PartialSlipContact a, b;
  a.move(1e-6, {}), b.move(1e-6, {});
  const double s = sliding_slip(a), c = std::cos(0.7), si = std::sin(0.7);
  Random random(5);
  for (int k = 0; k < 2000; ++k) {
    const double x = 0.1 * s * random.normal(), y = 0.1 * s * random.normal(), d = 1e-6 * random.uniform(0.5, 1.5);
    a.move(d, {x, y, 0}), b.move(d, {c * x - si * y, si * x + c * y, 0});
    ASSERT_LE(norm(a.shear()), a.limit() * (1 + 1e-12));
    ASSERT_NEAR(b.shear().x, c * a.shear().x - si * a.shear().y, 1e-6 * a.limit()) << k;
    ASSERT_GE(a.loss, -1e-12 * s * a.limit());
  }
}

TEST(PartialSlip, RoughContactsSlipAlike) {
  Contact<RoughPartialSlip> c;
  c.move(2e-6, {});
  const double s = sliding_slip(c);
  c.slip(0.5 * s, 0, 7);
  EXPECT_NEAR(c.shear().x / c.limit(), 1 - std::pow(0.5, 1.5), 1e-9);
}

}  // namespace
