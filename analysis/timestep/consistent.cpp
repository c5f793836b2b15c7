#include "timestep/consistent.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>

#include "assembly/stiffness.hpp"
#include "eigen/arpack_general.hpp"

namespace eg {
namespace {

using Sparse = Eigen::SparseMatrix<double, Eigen::RowMajor>;

Sparse scaled_tangent(const Scene& scene, const State& state, const Network& network) {
  Sparse a = assemble_blocks(consistent_blocks(scene, state), network);
  const std::vector<double> inverse = inverse_mass_diagonal(network);
  const auto scale = [&](Eigen::Index k) { return std::sqrt(inverse[static_cast<std::size_t>(k)]); };
  for (Eigen::Index row = 0; row < a.outerSize(); ++row)
    for (Sparse::InnerIterator it(a, row); it; ++it) it.valueRef() *= scale(row) * scale(it.col());
  return a;
}

/// ‖A_ij‖₂ of the d×d blocks of grains.
Sparse block_norms(const Sparse& a, int d) {
  const Eigen::Index grains = a.rows() / d;
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index g = 0; g < grains; ++g) {
    std::map<Eigen::Index, Eigen::MatrixXd> blocks;
    for (int r = 0; r < d; ++r)
      for (Sparse::InnerIterator it(a, g * d + r); it; ++it) {
        auto& block = blocks.try_emplace(it.col() / d, Eigen::MatrixXd::Zero(d, d)).first->second;
        block(r, it.col() % d) = it.value();
      }
    for (const auto& [column, block] : blocks) {
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(block.transpose() * block, Eigen::EigenvaluesOnly);
      const double norm = std::sqrt(std::max(0.0, solver.eigenvalues().maxCoeff())) * (1 + 1e-12);
      entries.emplace_back(static_cast<int>(g), static_cast<int>(column), norm);
    }
  }
  Sparse n(grains, grains);
  n.setFromTriplets(entries.begin(), entries.end());
  return n;
}

/// ρ(A) ≤ max_i (Ny)_i/y_i for every y > 0 (Varga 2000, section 2.1).
double radius_bound(const Sparse& a, int d) {
  const Sparse n = block_norms(a, d);
  const Eigen::VectorXd diagonal = n.diagonal();
  Eigen::VectorXd y = Eigen::VectorXd::Ones(n.rows());
  double best = HUGE_VAL;
  for (int sweep = 0; sweep <= 40; ++sweep) {
    Eigen::VectorXd product = n * y;
    best = std::min(best, product.cwiseQuotient(y).maxCoeff());
    product += 0.5 * diagonal.cwiseProduct(y);
    if (!(product.maxCoeff() > 0)) return 0;
    y = (product / product.maxCoeff()).cwiseMax(1e-30);
  }
  return best * (1 + 1e-12);
}

std::vector<std::complex<double>> whole_spectrum(const Sparse& a) {
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(Eigen::MatrixXd(a), false);
  return {solver.eigenvalues().begin(), solver.eigenvalues().end()};
}

std::vector<std::complex<double>> ends_of_spectrum(const Sparse& a, int wanted) {
  const auto apply = [&](std::span<const double> x, std::span<double> y) {
    const auto size = static_cast<Eigen::Index>(x.size());
    Eigen::Map<Eigen::VectorXd>(y.data(), size).noalias() = a * Eigen::Map<const Eigen::VectorXd>(x.data(), size);
  };
  std::vector<std::complex<double>> values;
  using enum SpectrumEnd;
  for (const SpectrumEnd end : {largest_magnitude, largest_imaginary, smallest_real})
    for (const auto& found : arpack_general(static_cast<std::size_t>(a.rows()), apply, end, {.wanted = wanted})) {
      const auto same = [&](const std::complex<double>& v) { return std::abs(v - found) <= 1e-6 * std::abs(v); };
      if (std::none_of(values.begin(), values.end(), same)) values.push_back(found);
    }
  return values;
}

}  // namespace

ConsistentReport consistent_report(const Scene& scene, const State& state, const Network& network,
                                   const ConsistentOptions& options) {
  ConsistentReport report;
  visit_contacts(scene, state, [&](const ContactPoint& p) {
    ++report.contacts;
    if (p.limit > 0 && p.sliding()) ++report.sliding;
  });
  const Sparse a = scaled_tangent(scene, state, network);
  const Sparse transposed = a.transpose();
  if (const double size = a.norm(); size > 0) report.asymmetry = (a - transposed).norm() / size;
  report.radius_upper = radius_bound(a, network.dofs_per_grain());
  report.complete = static_cast<std::size_t>(a.rows()) <= options.dense_limit;
  report.spectrum = classify(report.complete ? whole_spectrum(a) : ends_of_spectrum(a, options.wanted));
  return report;
}

}  // namespace eg
