#pragma once
// Dense symmetric eigenproblems for small systems: all eigenvalues, by Householder reduction and QR (Eigen).
#include <Eigen/Core>
#include <vector>

#include "eigen/operator.hpp"
#include "eigen/result.hpp"

namespace eg {

/// The largest eigenpair of a symmetric matrix (its lower triangle is read).
EigenResult dense_largest(const Eigen::MatrixXd& matrix);

/// Bound of the round-off error of every eigenvalue that dense_largest() returns, relative to the largest modulus:
/// a few n ε (Golub and Van Loan 2013, section 8.3).
double dense_relative_error(std::size_t rows);

/// The matrix of an operator, a column a product.
template <LinearOperator A>
Eigen::MatrixXd dense_matrix(const A& a) {
  const auto n = static_cast<Eigen::Index>(a.rows());
  Eigen::MatrixXd matrix(n, n);
  std::vector<double> unit(a.rows(), 0.0), column(a.rows());
  for (std::size_t k = 0; k < a.rows(); ++k) {
    unit[k] = 1;
    a.apply(unit, column);
    unit[k] = 0;
    matrix.col(static_cast<Eigen::Index>(k)) = Eigen::Map<const Eigen::VectorXd>(column.data(), n);
  }
  return matrix;
}

}  // namespace eg
