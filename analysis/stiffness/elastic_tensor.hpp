#pragma once
// A linear elastic tensor and what follows from it by algebra alone. Voigt's order: xx yy zz yz xz xy (2D: xx yy xy),
// engineering shear strains; [Pa], 2D [N/m].
#include <Eigen/Core>
#include <array>

#include "base/vec.hpp"

namespace eg {

struct ElasticTensor {
  int dimension = 3;
  Eigen::MatrixXd voigt;  ///< 6×6 or 3×3, symmetric

  int size() const { return static_cast<int>(voigt.rows()); }
};

/// Row of Voigt's matrix that belongs to component (i, j).
int voigt_row(int dimension, int i, int j);
/// The component (i, j), i ≤ j, of a row of Voigt's matrix.
std::array<int, 2> voigt_component(int dimension, int row);
const char* voigt_name(int dimension, int row);  ///< "xx" …

/// C as a linear map of symmetric tensors in an orthonormal basis (Kelvin 1856; Mandel 1965): shear rows times √2. Its
/// eigenvalues and its Frobenius norm are those of the tensor.
Eigen::MatrixXd kelvin_matrix(const ElasticTensor& tensor);
ElasticTensor from_kelvin(int dimension, const Eigen::MatrixXd& kelvin);

/// C'_ijkl = R_ia R_jb R_kc R_ld C_abcd.
ElasticTensor rotated(const ElasticTensor& tensor, const Mat3& rotation);

/// Eigenvalues of the Kelvin matrix, ascending: the moduli of the six (three) eigenstrains. All positive: stable.
Eigen::VectorXd eigenmoduli(const ElasticTensor& tensor);

/// C_ijkk: the stress that isotropic extension calls up; its principal directions are those of the tensor.
Mat3 dilatational_tensor(const ElasticTensor& tensor);

/// Young's modulus along the unit vector n, lateral stress constant.
double young_modulus(const ElasticTensor& tensor, const Vec3& n);
/// Lateral contraction along m for extension along n, both unit, m ⊥ n.
double poisson_ratio(const ElasticTensor& tensor, const Vec3& n, const Vec3& m);
/// Mean over all lateral directions m (2D: the one there is).
double poisson_ratio(const ElasticTensor& tensor, const Vec3& n);

/// Plane waves along the unit vector n (Christoffel 1877): ρ c² are the eigenvalues of n·C·n.
struct WaveSpeeds {
  std::array<double, 3> speed{};       ///< [m/s], fastest first: P, S1, S2; 2D: P, S
  std::array<Vec3, 3> polarisation{};  ///< unit
};
WaveSpeeds wave_speeds(const ElasticTensor& tensor, double density, const Vec3& n);

}  // namespace eg
