#include "eigen/sparse_cholesky.hpp"

#include <fmt/format.h>
#include <suitesparse/cholmod.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <vector>

#include "base/error.hpp"

namespace eg {
namespace {

/// CHOLMOD's view of the lower triangle of an Eigen matrix; owns nothing and is only read.
cholmod_sparse view_of(const Eigen::SparseMatrix<double>& a) {
  cholmod_sparse view{};
  view.nrow = static_cast<std::size_t>(a.rows());
  view.ncol = static_cast<std::size_t>(a.cols());
  view.nzmax = static_cast<std::size_t>(a.nonZeros());
  view.p = const_cast<int*>(a.outerIndexPtr());
  view.i = const_cast<int*>(a.innerIndexPtr());
  view.x = const_cast<double*>(a.valuePtr());
  view.stype = -1;
  view.itype = CHOLMOD_INT, view.xtype = CHOLMOD_REAL, view.dtype = CHOLMOD_DOUBLE;
  view.sorted = view.packed = 1;
  return view;
}

/// The pattern of blocks, lower triangle, every block once.
Eigen::SparseMatrix<double> block_pattern(const Eigen::SparseMatrix<double>& a, int block) {
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<int> seen(static_cast<std::size_t>(a.rows() / block), -1);
  for (int column = 0; column < a.cols(); ++column)
    for (Eigen::SparseMatrix<double>::InnerIterator it(a, column); it; ++it) {
      const int row = static_cast<int>(it.row()) / block, to = column / block;
      if (row < to || seen[static_cast<std::size_t>(row)] == to) continue;
      seen[static_cast<std::size_t>(row)] = to;
      entries.emplace_back(row, to, 1.0);
    }
  Eigen::SparseMatrix<double> pattern(a.rows() / block, a.cols() / block);
  pattern.setFromTriplets(entries.begin(), entries.end());
  return pattern;
}

}  // namespace

struct SparseCholesky::Work {
  int block;
  cholmod_common common{};
  cholmod_factor* factor = nullptr;
  std::vector<int> outer, inner;  ///< pattern that `factor` was ordered for
  bool ready = false;

  explicit Work(int b) : block(b) {
    cholmod_start(&common);
    common.print = 0;
    common.quick_return_if_not_posdef = 1;
    common.supernodal = CHOLMOD_SUPERNODAL;
    common.nmethods = 1;
    common.method[0].ordering = CHOLMOD_GIVEN;
  }
  ~Work() {
    cholmod_free_factor(&factor, &common);
    cholmod_finish(&common);
  }
  Work(const Work&) = delete;
  Work& operator=(const Work&) = delete;

  bool is_ordered_for(const Eigen::SparseMatrix<double>& a) const {
    return factor && std::equal(outer.begin(), outer.end(), a.outerIndexPtr(), a.outerIndexPtr() + a.cols() + 1) &&
           std::equal(inner.begin(), inner.end(), a.innerIndexPtr(), a.innerIndexPtr() + a.nonZeros());
  }
  void order(const Eigen::SparseMatrix<double>& a);
  void check() const {
    if (common.status < CHOLMOD_OK)
      throw RunError(fmt::format("sparse Cholesky: {}; use a smaller packing or an iterative method",
                                 common.status == CHOLMOD_OUT_OF_MEMORY ? "not enough memory for the factor"
                                                                        : "the matrix is too large for CHOLMOD"));
  }
};

void SparseCholesky::Work::order(const Eigen::SparseMatrix<double>& a) {
  cholmod_free_factor(&factor, &common);
  const Eigen::SparseMatrix<double> pattern = block_pattern(a, block);
  cholmod_sparse graph = view_of(pattern);
  std::vector<int> blocks(static_cast<std::size_t>(pattern.rows())), rows;
  cholmod_metis(&graph, nullptr, 0, 1, blocks.data(), &common);
  check();
  for (const int b : blocks)
    for (int k = 0; k < block; ++k) rows.push_back(b * block + k);
  cholmod_sparse matrix = view_of(a);
  factor = cholmod_analyze_p(&matrix, rows.data(), nullptr, 0, &common);
  check();
  outer.assign(a.outerIndexPtr(), a.outerIndexPtr() + a.cols() + 1);
  inner.assign(a.innerIndexPtr(), a.innerIndexPtr() + a.nonZeros());
}

SparseCholesky::SparseCholesky(int block) : work_(std::make_unique<Work>(block)) {}
SparseCholesky::~SparseCholesky() = default;
SparseCholesky::SparseCholesky(SparseCholesky&&) noexcept = default;
SparseCholesky& SparseCholesky::operator=(SparseCholesky&&) noexcept = default;

bool SparseCholesky::factorise(const Eigen::SparseMatrix<double>& a) {
  Work& w = *work_;
  assert(a.isCompressed() && a.rows() == a.cols() && a.rows() % w.block == 0);
  w.ready = false;
  // Some LAPACKs take the root of a NaN without complaint.
  if (!std::all_of(a.valuePtr(), a.valuePtr() + a.nonZeros(), [](double x) { return std::isfinite(x); })) return false;
  if (!w.is_ordered_for(a)) w.order(a);
  cholmod_sparse matrix = view_of(a);
  cholmod_factorize(&matrix, w.factor, &w.common);
  w.check();
  w.ready = w.common.status == CHOLMOD_OK && w.factor->minor == w.factor->n;
  return w.ready;
}

void SparseCholesky::solve(std::span<const double> b, std::span<double> x) {
  Work& w = *work_;
  assert(w.ready && b.size() == w.factor->n && x.size() == b.size());
  cholmod_dense right{};
  right.nrow = right.d = right.nzmax = b.size(), right.ncol = 1;
  right.x = const_cast<double*>(b.data());
  right.xtype = CHOLMOD_REAL, right.dtype = CHOLMOD_DOUBLE;
  cholmod_dense* solution = cholmod_solve(CHOLMOD_A, w.factor, &right, &w.common);
  w.check();
  std::copy_n(static_cast<const double*>(solution->x), x.size(), x.begin());
  cholmod_free_dense(&solution, &w.common);
}

std::size_t SparseCholesky::factor_entries() const { return work_->factor ? work_->factor->xsize : 0; }

double cholesky_margin(const Eigen::SparseMatrix<double>& a) {
  double trace = 0;
  for (Eigen::Index k = 0; k < a.rows(); ++k) trace += std::abs(a.coeff(k, k));
  return 2 * (static_cast<double>(a.rows()) + 8) * std::numeric_limits<double>::epsilon() * trace;
}

}  // namespace eg
