// Algebra of elastic tensors: exact for isotropic and cubic ones, blind to the frame.
#include <gtest/gtest.h>

#include <cmath>

#include "base/random.hpp"
#include "stiffness/effective_medium.hpp"
#include "stiffness/symmetry_fit.hpp"

namespace eg {
namespace {

Mat3 turn_about(Vec3 axis, double angle) {  // Rodrigues
  axis *= 1 / norm(axis);
  Mat3 r;
  for (int k = 0; k < 3; ++k) {
    Vec3 e;
    e[k] = 1;
    const Vec3 v = std::cos(angle) * e + std::sin(angle) * cross(axis, e) + (1 - std::cos(angle)) * dot(axis, e) * axis;
    for (int i = 0; i < 3; ++i) r(i, k) = v[i];
  }
  return r;
}

ElasticTensor isotropic(int dimension, double k, double g) {
  const int rows = dimension == 3 ? 6 : 3;
  ElasticTensor t{dimension, Eigen::MatrixXd::Zero(rows, rows)};
  t.voigt.topLeftCorner(dimension, dimension).setConstant(k - 2 * g / dimension);
  for (int a = 0; a < rows; ++a) t.voigt(a, a) += a < dimension ? 2 * g : g;
  return t;
}

ElasticTensor random_tensor(int dimension, std::uint64_t seed) {
  Random random(seed);
  const int rows = dimension == 3 ? 6 : 3;
  Eigen::MatrixXd a(rows, rows);
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < rows; ++j) a(i, j) = random.normal();
  return {dimension, a * a.transpose() + 5 * Eigen::MatrixXd::Identity(rows, rows)};
}

ElasticTensor transverse(double c11, double c33, double c13, double c44, double c66) {
  ElasticTensor t{3, Eigen::MatrixXd::Zero(6, 6)};
  auto& c = t.voigt;
  c(0, 0) = c(1, 1) = c11, c(2, 2) = c33, c(0, 2) = c(2, 0) = c(1, 2) = c(2, 1) = c13;
  c(0, 1) = c(1, 0) = c11 - 2 * c66, c(3, 3) = c(4, 4) = c44, c(5, 5) = c66;
  return t;
}

TEST(ElasticTensor, IsotropicOnesAreTheSameInEveryFrame) {
  for (const int d : {2, 3}) {
    const double k = 3, g = 1.3, rho = 2;
    const auto t = isotropic(d, k, g);
    const Mat3 r = d == 3 ? turn_about({1, 2, -1}, 0.7) : turn_about({0, 0, 1}, 0.7);
    EXPECT_LE((rotated(t, r).voigt - t.voigt).norm(), 1e-14 * t.voigt.norm());
    const auto fit = isotropic_fit(t);
    EXPECT_NEAR(fit.bulk, k, 1e-14);
    EXPECT_NEAR(fit.shear, g, 1e-14);
    EXPECT_LE(fit.misfit, 1e-14);
    const Vec3 n = r * Vec3{1, 0, 0};
    EXPECT_NEAR(young_modulus(t, n), fit.young, 1e-13);
    EXPECT_NEAR(poisson_ratio(t, n), fit.poisson, 1e-13);
    EXPECT_NEAR(poisson_ratio(t, n, r * Vec3{0, 1, 0}), fit.poisson, 1e-13);
    const auto waves = wave_speeds(t, rho, n);
    EXPECT_NEAR(waves.speed[0], std::sqrt((k + 2 * g * (d - 1) / d) / rho), 1e-13);
    EXPECT_NEAR(waves.speed[1], std::sqrt(g / rho), 1e-13);
    EXPECT_NEAR(std::abs(dot(waves.polarisation[0], n)), 1, 1e-13);
  }
  EXPECT_NEAR(isotropic_fit(isotropic(3, 3, 1.3)).young, 9 * 3 * 1.3 / (3 * 3 + 1.3), 1e-13);
}

TEST(ElasticTensor, RotationKeepsEigenmoduliAndTurnsTheRest) {
  const auto t = random_tensor(3, 2);
  const Mat3 r = turn_about({0.3, -1, 0.5}, 1.9);
  const auto s = rotated(t, r);
  EXPECT_LE((eigenmoduli(s) - eigenmoduli(t)).norm(), 1e-12 * eigenmoduli(t).norm());
  EXPECT_LE((rotated(s, transpose(r)).voigt - t.voigt).norm(), 1e-13 * t.voigt.norm());
  const Vec3 n{0.6, 0, 0.8};
  EXPECT_NEAR(young_modulus(s, r * n) / young_modulus(t, n), 1, 1e-12);
  EXPECT_NEAR(wave_speeds(s, 2, r * n).speed[2] / wave_speeds(t, 2, n).speed[2], 1, 1e-12);
  const Mat3 turned = r * dilatational_tensor(t) * transpose(r), direct = dilatational_tensor(s);
  for (std::size_t k = 0; k < 9; ++k) EXPECT_NEAR(direct.a[k], turned.a[k], 1e-11);
}

TEST(ElasticTensor, CubicSpeedsAlongTheAxesAndDiagonals) {
  ElasticTensor t = isotropic(3, 1, 1);
  const double c11 = 10, c12 = 3, c44 = 4, rho = 2;
  t.voigt.topLeftCorner(3, 3).setConstant(c12);
  for (int a = 0; a < 6; ++a) t.voigt(a, a) = a < 3 ? c11 : c44;
  const double r2 = std::sqrt(0.5), r3 = std::sqrt(1. / 3);
  const auto along = [&](const Vec3& n) { return wave_speeds(t, rho, n).speed; };
  EXPECT_NEAR(along({1, 0, 0})[0], std::sqrt(c11 / rho), 1e-13);
  EXPECT_NEAR(along({1, 0, 0})[2], std::sqrt(c44 / rho), 1e-13);
  EXPECT_NEAR(along({r2, r2, 0})[0], std::sqrt((c11 + c12 + 2 * c44) / 2 / rho), 1e-13);
  EXPECT_NEAR(along({r2, r2, 0})[1], std::sqrt(c44 / rho), 1e-13);
  EXPECT_NEAR(along({r2, r2, 0})[2], std::sqrt((c11 - c12) / 2 / rho), 1e-13);
  EXPECT_NEAR(along({r3, r3, r3})[0], std::sqrt((c11 + 2 * c12 + 4 * c44) / 3 / rho), 1e-13);
  EXPECT_NEAR(along({r3, r3, r3})[1], std::sqrt((c11 - c12 + c44) / 3 / rho), 1e-13);
  EXPECT_GT(isotropic_fit(t).misfit, 0.01);
}

TEST(SymmetryFit, FindsTheAxisOfATransverselyIsotropicTensor) {
  const auto t = transverse(10, 7, 3, 2, 3);
  for (const Vec3& a : {Vec3{0, 0, 1}, Vec3{1, 0, 0}, Vec3{0.48, -0.6, 0.64}}) {
    const Vec3 axis = cross({0, 0, 1}, a);
    const Mat3 r = norm(axis) > 0 ? turn_about(axis, std::acos(a.z)) : Mat3::identity();
    const auto fit = transverse_fit(rotated(t, r));
    EXPECT_NEAR(std::abs(dot(fit.axis, a)), 1, 1e-10);
    EXPECT_LE(fit.misfit, 1e-5);
    EXPECT_NEAR(fit.c11, 10, 1e-4);
    EXPECT_NEAR(fit.c33, 7, 1e-4);
    EXPECT_NEAR(fit.c13, 3, 1e-4);
    EXPECT_NEAR(fit.c44, 2, 1e-4);
    EXPECT_NEAR(fit.c66, 3, 1e-4);
  }
}

TEST(SymmetryFit, IsAProjection) {
  const auto t = random_tensor(3, 9);
  const auto iso = isotropic_fit(t);
  const auto fit = transverse_fit(t);
  EXPECT_LT(fit.misfit, iso.misfit);
  EXPECT_LE(fit.misfit, transverse_fit(t, {0, 0, 1}).misfit);
  for (const double dk : {-0.1, 0.1})  // no other isotropic tensor is nearer
    for (const double dg : {-0.1, 0.1}) {
      const auto other = isotropic(3, iso.bulk + dk, iso.shear + dg);
      EXPECT_GT((kelvin_matrix(t) - kelvin_matrix(other)).norm() / kelvin_matrix(t).norm(), iso.misfit);
    }
}

TEST(EffectiveMedium, ReferenceValues) {
  const MeanPacking m{6, 0.62, 1e-3};
  const auto rough = walton_rough(m, 29e9, 0.12, 100e3), smooth = walton_smooth(m, 29e9, 0.12, 100e3);
  EXPECT_NEAR(rough.bulk / 2.0375804e8, 1, 1e-7);
  EXPECT_NEAR(rough.shear / 2.9393181e8, 1, 1e-7);
  EXPECT_NEAR(smooth.bulk / 2.0375804e8, 1, 1e-7);
  EXPECT_NEAR(smooth.shear / 1.2225483e8, 1, 1e-7);
  EXPECT_GT(walton_rough(m, 29e9, 0.12, 800e3).bulk / rough.bulk, 1.9999);  // p^(1/3)
  const double a = 1e-5;                                                    // a bond much wider than what p adds
  const auto bonded = digby(m, 29e9, 0.12, 1, a);
  EXPECT_NEAR(bonded.bulk / mean_field(m, 2 * 29e9 * a / 0.88, 0).bulk, 1, 1e-6);
  EXPECT_NEAR(bonded.shear / mean_field(m, 2 * 29e9 * a / 0.88, 4 * 29e9 * a / 1.88).shear, 1, 1e-6);
}

}  // namespace
}  // namespace eg
