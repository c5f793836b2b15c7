#include "stiffness/symmetry_fit.hpp"

#include <cmath>
#include <numbers>

namespace eg {
namespace {

constexpr double pi = std::numbers::pi;

/// Rotation that takes z to the unit vector n.
Mat3 frame_of(const Vec3& n) {
  const Vec3 helper = std::abs(n.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  Vec3 a = cross(helper, n);
  a *= 1 / norm(a);
  const Vec3 b = cross(n, a);
  Mat3 r;
  for (int i = 0; i < 3; ++i) r(i, 0) = a[i], r(i, 1) = b[i], r(i, 2) = n[i];
  return r;
}

Mat3 about_z(double angle) {
  Mat3 r = Mat3::identity();
  r(0, 0) = r(1, 1) = std::cos(angle);
  r(0, 1) = -std::sin(angle), r(1, 0) = std::sin(angle);
  return r;
}

/// Mean over all turns about z. Components are trigonometric polynomials of degree 4, so eight turns give it exactly.
ElasticTensor mean_about_z(const ElasticTensor& tensor) {
  ElasticTensor mean{tensor.dimension, Eigen::MatrixXd::Zero(tensor.size(), tensor.size())};
  for (int k = 0; k < 8; ++k) mean.voigt += rotated(tensor, about_z(k * pi / 4)).voigt / 8;
  return mean;
}

double misfit(const ElasticTensor& tensor, const ElasticTensor& fit) {
  const double size = kelvin_matrix(tensor).norm();
  return size > 0 ? (kelvin_matrix(tensor) - kelvin_matrix(fit)).norm() / size : 0;
}

}  // namespace

IsotropicFit isotropic_fit(const ElasticTensor& tensor) {
  const int d = tensor.dimension;
  const Eigen::MatrixXd kelvin = kelvin_matrix(tensor);
  const double dilation = kelvin.topLeftCorner(d, d).sum(), shears = tensor.size() - 1;  // eigenspaces of I ⊗ I
  IsotropicFit fit;
  fit.bulk = dilation / (d * d);
  fit.shear = (kelvin.trace() - dilation / d) / (2 * shears);
  const double k = fit.bulk, g = fit.shear;
  if (k > 0) {
    fit.young = d == 3 ? 9 * k * g / (3 * k + g) : 4 * k * g / (k + g);
    fit.poisson = d == 3 ? (3 * k - 2 * g) / (2 * (3 * k + g)) : (k - g) / (k + g);
  }
  Eigen::MatrixXd isotropic = 2 * g * Eigen::MatrixXd::Identity(tensor.size(), tensor.size());
  isotropic.topLeftCorner(d, d).array() += k - 2 * g / d;
  fit.misfit = misfit(tensor, from_kelvin(d, isotropic));
  return fit;
}

TransverseFit transverse_fit(const ElasticTensor& tensor, const Vec3& axis) {
  const ElasticTensor turned = rotated(tensor, transpose(frame_of(axis)));
  const ElasticTensor mean = mean_about_z(turned);
  const auto& c = mean.voigt;
  return {axis.z < 0 ? -axis : axis, c(0, 0), c(2, 2), c(0, 2), c(3, 3), c(5, 5), misfit(turned, mean)};
}

TransverseFit transverse_fit(const ElasticTensor& tensor) {
  TransverseFit best = transverse_fit(tensor, {0, 0, 1});
  const auto look = [&](const Vec3& axis) {
    const TransverseFit fit = transverse_fit(tensor, (1 / norm(axis)) * axis);
    if (fit.misfit < best.misfit - 1e-13) best = fit;  // z unless another axis is better beyond round-off
  };
  constexpr int points = 300;  // a spiral over the half sphere (Vogel 1979): every axis within some 0.1 rad
  for (int k = 0; k < points; ++k) {
    const double z = (k + 0.5) / points, turn = k * pi * (3 - std::sqrt(5.0)), s = std::sqrt(1 - z * z);
    look({s * std::cos(turn), s * std::sin(turn), z});
  }
  for (double step = 0.1; step > 1e-6;) {
    const double before = best.misfit;
    const Mat3 frame = frame_of(best.axis);
    for (const Vec3& move : {Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, -1, 0}})
      look(frame * (step * move + Vec3{0, 0, 1}));
    if (!(best.misfit < before)) step /= 2;
  }
  return best;
}

}  // namespace eg
