#include "timestep/sparse_certificate.hpp"

#include <cmath>
#include <limits>

#include "assembly/stiffness.hpp"
#include "eigen/sparse_cholesky.hpp"

namespace eg {
namespace {

/// Round-off of the entries of M^−½KM^−½: sums of at most `most` products of some ten operations, each below λmax in
/// size, in rows of at most 6 (most + 1) entries.
double assembly_margin(const Eigen::SparseMatrix<double>& a, double sigma) {
  Eigen::Index most = 0;
  for (Eigen::Index k = 0; k < a.cols(); ++k) most = std::max<Eigen::Index>(most, a.col(k).nonZeros());
  const auto row = static_cast<double>(most);
  return 4 * (row + 32) * row * std::numeric_limits<double>::epsilon() * sigma;
}

}  // namespace

bool sparse_cholesky_below(const Network& network, double sigma) {
  Eigen::SparseMatrix<double> a = stiffness_matrix(network);
  const std::vector<double> inverse_mass = inverse_mass_diagonal(network);
  for (int column = 0; column < a.cols(); ++column)
    for (Eigen::SparseMatrix<double>::InnerIterator it(a, column); it; ++it)
      it.valueRef() *= -std::sqrt(inverse_mass[static_cast<std::size_t>(it.row())]) *
                       std::sqrt(inverse_mass[static_cast<std::size_t>(column)]);
  for (int k = 0; k < a.cols(); ++k) a.coeffRef(k, k) += sigma;
  const double margin = cholesky_margin(a) + assembly_margin(a, sigma);
  for (int k = 0; k < a.cols(); ++k) a.coeffRef(k, k) -= margin;
  return SparseCholesky(network.dofs_per_grain()).factorise(a);
}

}  // namespace eg
