#pragma once
// The elastic tensor of a network by dense linear algebra: C = C_affine − Ξᵀ K⁺ Ξ / V, Ξ = Σ Bᵀ k e.
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "assembly/stiffness.hpp"
#include "stiffness/load_cases.hpp"

namespace eg::test {

struct DenseProblem {
  Eigen::MatrixXd k, xi, affine;  ///< affine: Σ eᵀ k e, not yet over V
};

/// Rotations in units of the first grain's radius, or the spectrum would be split by units.
inline DenseProblem dense_problem(const Network& net) {
  const auto loads = periodic_strains(net.dimension);
  const auto components = active_components(net);
  const auto d = static_cast<Eigen::Index>(components.size()), n = static_cast<Eigen::Index>(total_dofs(net));
  DenseProblem p{Eigen::MatrixXd(stiffness_matrix(net)), Eigen::MatrixXd::Zero(n, loads.count()),
                 Eigen::MatrixXd::Zero(loads.count(), loads.count())};
  for (const Spring& s : net.springs) {
    Eigen::Matrix<double, 3, Eigen::Dynamic> e(3, loads.count());
    for (int a = 0; a < loads.count(); ++a) {
      const Vec3 jump = loads.jump(s, a);
      e.col(a) << jump.x, jump.y, jump.z;
    }
    const Eigen::Matrix<double, 3, Eigen::Dynamic> ke = contact_stiffness(s) * e;
    p.affine += e.transpose() * ke;
    for (const auto side : {ContactSide::first, ContactSide::second}) {
      const Eigen::MatrixXd f = side_matrix(s, side).transpose() * ke;
      const auto at = static_cast<Eigen::Index>(side == ContactSide::first ? s.i : s.j) * d;
      for (Eigen::Index k = 0; k < d; ++k) p.xi.row(at + k) += f.row(components[static_cast<std::size_t>(k)]);
    }
  }
  Eigen::VectorXd unit(n);
  for (Eigen::Index k = 0; k < n; ++k)
    unit(k) = components[static_cast<std::size_t>(k % d)] < 3 ? 1 : 1 / net.radius.front();
  for (Eigen::Index k = 0; k < n; ++k) p.k.col(k).array() *= unit(k) * unit.array();
  p.xi = unit.asDiagonal() * p.xi;
  return p;
}

/// By the pseudo-inverse: all eigenvectors of K.
inline Eigen::MatrixXd dense_tensor(const Network& net, double volume) {
  const DenseProblem p = dense_problem(net);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(p.k);
  const Eigen::MatrixXd modes = solver.eigenvectors().transpose() * p.xi;
  Eigen::MatrixXd c = p.affine;
  for (Eigen::Index m = 0; m < modes.rows(); ++m)
    if (const double lambda = solver.eigenvalues()(m); lambda > 1e-11 * solver.eigenvalues().tail<1>()(0))
      c -= modes.row(m).transpose() * modes.row(m) / lambda;
  return c / volume;
}

/// By dense Cholesky of K + σ, σ = 1e-9 of the mean diagonal for the free motions, refined until σ does not matter: for
/// networks whose eigenvectors would take hours.
inline Eigen::MatrixXd dense_tensor_by_cholesky(const Network& net, double volume) {
  DenseProblem p = dense_problem(net);
  const Eigen::SparseMatrix<double> k = p.k.sparseView();
  p.k.diagonal().array() += 1e-9 * p.k.trace() / static_cast<double>(p.k.rows());
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factor(p.k);  // in place
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(p.xi.rows(), p.xi.cols());
  for (int pass = 0; pass < 6; ++pass) x += factor.solve(p.xi - k * x);
  return (p.affine - p.xi.transpose() * x) / volume;
}

}  // namespace eg::test
