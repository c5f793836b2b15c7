#include "stiffness/elastic_tensor.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <numbers>

namespace eg {
namespace {

constexpr double root2 = std::numbers::sqrt2;

/// Orthonormal basis of symmetric tensors, in Voigt's order.
Mat3 basis(int dimension, int row) {
  const auto [i, j] = voigt_component(dimension, row);
  Mat3 e;
  e(i, j) = e(j, i) = i == j ? 1.0 : 1 / root2;
  return e;
}

/// Components of a symmetric tensor in that basis.
Eigen::VectorXd kelvin_vector(int dimension, const Mat3& m) {
  const int rows = dimension == 3 ? 6 : 3;
  Eigen::VectorXd v(rows);
  for (int a = 0; a < rows; ++a) {
    const auto [i, j] = voigt_component(dimension, a);
    v(a) = i == j ? m(i, i) : root2 / 2 * (m(i, j) + m(j, i));
  }
  return v;
}

Eigen::MatrixXd compliance(const ElasticTensor& tensor) { return kelvin_matrix(tensor).inverse(); }

}  // namespace

std::array<int, 2> voigt_component(int dimension, int row) {
  constexpr std::array<std::array<int, 2>, 6> solid{{{0, 0}, {1, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}}};
  return solid[static_cast<std::size_t>(dimension == 3 || row < 2 ? row : 5)];
}

int voigt_row(int dimension, int i, int j) {
  if (i == j) return i;
  return dimension == 3 ? 6 - i - j : 2;
}

const char* voigt_name(int dimension, int row) {
  constexpr std::array<const char*, 6> names{"xx", "yy", "zz", "yz", "xz", "xy"};
  return names[static_cast<std::size_t>(dimension == 3 || row < 2 ? row : 5)];
}

Eigen::MatrixXd kelvin_matrix(const ElasticTensor& tensor) {
  Eigen::VectorXd scale(tensor.size());
  for (int a = 0; a < tensor.size(); ++a) scale(a) = a < tensor.dimension ? 1.0 : root2;
  return scale.asDiagonal() * tensor.voigt * scale.asDiagonal();
}

ElasticTensor from_kelvin(int dimension, const Eigen::MatrixXd& kelvin) {
  Eigen::VectorXd scale(kelvin.rows());
  for (int a = 0; a < kelvin.rows(); ++a) scale(a) = a < dimension ? 1.0 : 1 / root2;
  return {dimension, scale.asDiagonal() * kelvin * scale.asDiagonal()};
}

ElasticTensor rotated(const ElasticTensor& tensor, const Mat3& rotation) {
  Eigen::MatrixXd q(tensor.size(), tensor.size());
  for (int b = 0; b < tensor.size(); ++b)
    q.col(b) = kelvin_vector(tensor.dimension, rotation * basis(tensor.dimension, b) * transpose(rotation));
  return from_kelvin(tensor.dimension, q * kelvin_matrix(tensor) * q.transpose());
}

Eigen::VectorXd eigenmoduli(const ElasticTensor& tensor) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(kelvin_matrix(tensor), Eigen::EigenvaluesOnly).eigenvalues();
}

Mat3 dilatational_tensor(const ElasticTensor& tensor) {
  Mat3 d;
  for (int a = 0; a < tensor.size(); ++a) {
    const auto [i, j] = voigt_component(tensor.dimension, a);
    d(i, j) = d(j, i) = tensor.voigt.row(a).head(tensor.dimension).sum();
  }
  return d;
}

double young_modulus(const ElasticTensor& tensor, const Vec3& n) {
  const Eigen::VectorXd v = kelvin_vector(tensor.dimension, outer(n, n));
  return 1 / v.dot(compliance(tensor) * v);
}

double poisson_ratio(const ElasticTensor& tensor, const Vec3& n, const Vec3& m) {
  const Eigen::VectorXd v = kelvin_vector(tensor.dimension, outer(n, n));
  const Eigen::VectorXd strain = compliance(tensor) * v;
  return -kelvin_vector(tensor.dimension, outer(m, m)).dot(strain) / v.dot(strain);
}

double poisson_ratio(const ElasticTensor& tensor, const Vec3& n) {
  Mat3 lateral;  // (1 − nn)/(D − 1): the mean of mm over m ⊥ n
  for (int i = 0; i < tensor.dimension; ++i)
    for (int j = 0; j < tensor.dimension; ++j) lateral(i, j) = ((i == j) - n[i] * n[j]) / (tensor.dimension - 1);
  const Eigen::VectorXd v = kelvin_vector(tensor.dimension, outer(n, n));
  const Eigen::VectorXd strain = compliance(tensor) * v;
  return -kelvin_vector(tensor.dimension, lateral).dot(strain) / v.dot(strain);
}

WaveSpeeds wave_speeds(const ElasticTensor& tensor, double density, const Vec3& n) {
  const int d = tensor.dimension;
  Eigen::MatrixXd acoustic = Eigen::MatrixXd::Zero(d, d);
  for (int i = 0; i < d; ++i)
    for (int k = 0; k < d; ++k)
      for (int j = 0; j < d; ++j)
        for (int l = 0; l < d; ++l)
          acoustic(i, k) += n[j] * n[l] * tensor.voigt(voigt_row(d, i, j), voigt_row(d, k, l));
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(acoustic);
  WaveSpeeds waves;
  for (int k = 0; k < d; ++k) {
    const int from = d - 1 - k;
    const auto to = static_cast<std::size_t>(k);
    waves.speed[to] = std::sqrt(std::max(solver.eigenvalues()(from), 0.0) / density);
    for (int i = 0; i < d; ++i) waves.polarisation[to][i] = solver.eigenvectors()(i, from);
  }
  return waves;
}

}  // namespace eg
