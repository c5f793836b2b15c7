#include "eigen/dense.hpp"

#include <Eigen/Eigenvalues>
#include <limits>

namespace eg {

EigenResult dense_largest(const Eigen::MatrixXd& matrix) {
  EigenResult result;
  result.method = "dense";
  result.converged = true;
  if (matrix.rows() == 0) return result;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
  const auto last = matrix.rows() - 1;
  const Eigen::VectorXd x = solver.eigenvectors().col(last);
  result.value = solver.eigenvalues()(last);
  result.residual = (matrix.selfadjointView<Eigen::Lower>() * x - result.value * x).norm();
  result.vector.assign(x.begin(), x.end());
  return result;
}

double dense_relative_error(std::size_t rows) {
  return (8.0 * static_cast<double>(rows) + 64.0) * std::numeric_limits<double>::epsilon();
}

}  // namespace eg
