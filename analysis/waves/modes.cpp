#include "waves/modes.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "assembly/apply.hpp"
#include "assembly/stiffness.hpp"
#include "base/error.hpp"
#include "eigen/inverse_krylov.hpp"
#include "eigen/lanczos.hpp"
#include "eigen/sparse_cholesky.hpp"

namespace eg {
namespace {

using Row = Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double>;

constexpr double zero_share = 1e-10;  // of λmax: ω² below it is no vibration
constexpr Row most_counted = 60000;   // rows up to which inertia is counted (a factor without supernodes)

/// A = M^−½KM^−½ and what is known of it.
struct Problem {
  Sparse a;
  VectorXd active;     ///< 1 for what can move and has stiffness
  std::size_t total;   ///< degrees of freedom that can move
  double highest = 0;  ///< λmax, a Ritz value [1/s²]
  int block;           ///< rows a grain

  double zero() const { return zero_share * highest; }
  Row idle() const { return a.rows() - static_cast<Row>(active.sum()); }
};

Problem problem_of(const Network& network) {
  Problem p;
  p.a = stiffness_matrix(network);
  p.block = network.dofs_per_grain();
  const auto inverse = inverse_mass_diagonal(network);
  const VectorXd scale = Eigen::Map<const VectorXd>(inverse.data(), static_cast<Row>(inverse.size())).cwiseSqrt();
  p.a = scale.asDiagonal() * p.a * scale.asDiagonal();
  p.total = static_cast<std::size_t>(std::ranges::count_if(inverse, [](double x) { return x > 0; }));
  p.active = (VectorXd(p.a.diagonal()).array() > 0).cast<double>();
  const StiffnessOperator fast(network, StiffnessOperator::Scaling::mass);
  p.highest = lanczos_largest(fast, {.tolerance = 1e-7}).value;
  if (!(p.highest > 0)) throw RunError("nothing in this packing can vibrate: no grain that can move touches anything");
  return p;
}

Sparse shifted(const Problem& p, double shift, double sign) {
  Sparse m = sign * p.a;
  for (Row k = 0; k < m.rows(); ++k) m.coeffRef(k, k) -= sign * shift;
  return m;
}

/// L D Lᵀ of A − σ without pivoting; a shift that hits an eigenvalue is moved by a hair.
class Factor {
 public:
  Factor(const Problem& p, double shift) : p_(p) {
    for (int attempt = 0; attempt < 5; ++attempt) {
      solver_.compute(shifted(p, shift, 1));
      if (solver_.info() == Eigen::Success) return;
      shift += 1e-9 * p.highest;
    }
    throw RunError("the matrix could not be factorised near this frequency; choose another one");
  }
  /// Active eigenvalues below the shift.
  Row below() const {
    const VectorXd d = solver_.vectorD();
    return (d.array() < 0).count() - p_.idle();
  }
  MatrixXd solve(const MatrixXd& x) const { return solver_.solve(x); }

 private:
  const Problem& p_;
  Eigen::SimplicialLDLT<Sparse> solver_;
};

BlockMap product(const Problem& p) {
  return [&p](const MatrixXd& x, MatrixXd& y) { y = p.a * x; };
}

/// (A − σ)⁻¹ by Cholesky of the definite one of A − σ and σ − A.
class DefiniteInverse {
 public:
  DefiniteInverse(const Problem& p, double shift, double sign) : sign_(sign), factor_(p.block) {
    if (!factor_.factorise(shifted(p, shift, sign)))
      throw RunError("the shifted stiffness is not definite: its springs are too unequal for shift-invert");
  }
  void operator()(const MatrixXd& x, MatrixXd& y) {
    y.resize(x.rows(), x.cols());
    const auto rows = static_cast<std::size_t>(x.rows());
    for (Row c = 0; c < x.cols(); ++c) factor_.solve({x.col(c).data(), rows}, {y.col(c).data(), rows});
    y *= sign_;
  }

 private:
  double sign_;
  SparseCholesky factor_;
};

Mode describe(const Network& network, double square, double residual, const VectorXd& shape) {
  Mode mode{square, residual, 0, 0};
  const auto components = active_components(network);
  double squares = 0;
  Row row = 0;
  for (std::size_t g = 0; g < network.size(); ++g) {
    double share = 0;
    for (const int c : components) {
      const double energy = shape(row) * shape(row);
      ++row;
      share += energy;
      if (c >= 3) mode.rotation += energy;
    }
    squares += share * share;
  }
  mode.participation = 1 / (static_cast<double>(network.size()) * squares);
  return mode;
}

/// Those of the pairs that vibrate and pass `wanted`.
template <class Wanted>
ModeSet mode_set(const Network& network, const Problem& p, const Eigenpairs& pairs, Wanted wanted) {
  ModeSet set;
  set.total = p.total;
  std::vector<Row> chosen;
  for (Row k = 0; k < pairs.value.size(); ++k)
    if (pairs.value(k) >= p.zero() && wanted(k)) chosen.push_back(k);
  set.shapes.resize(p.a.rows(), static_cast<Row>(chosen.size()));
  for (const Row k : chosen) {
    set.shapes.col(static_cast<Row>(set.modes.size())) = pairs.vectors.col(k);
    set.modes.push_back(describe(network, pairs.value(k), pairs.residual(k), pairs.vectors.col(k)));
  }
  return set;
}

void check(const Eigenpairs& pairs) {
  if (!pairs.converged) throw RunError("the modes did not converge; ask for fewer, or for all");
}

constexpr double apart = 1e-6;  // relative distance in ω² at which modes are counted, clear of round-off

}  // namespace

double Mode::frequency() const { return std::sqrt(std::max(square, 0.0)) / (2 * std::numbers::pi); }

ModeSet lowest_modes(const Network& network, std::size_t count) {
  const Problem p = problem_of(network);
  const bool countable = p.a.rows() <= most_counted;
  // Zero motions come first: how many there are is counted, or learnt by asking for more.
  Row zero = countable ? Factor(p, p.zero()).below() : network.dimension;
  DefiniteInverse inverse(p, -1e-4 * p.highest, 1);
  const auto most = static_cast<Row>(p.active.sum());
  for (;;) {
    const Row ask = std::min<Row>(zero + static_cast<Row>(count), most);
    const Eigenpairs pairs = eigenpairs_near(
        ask, [&](const MatrixXd& x, MatrixXd& y) { inverse(x, y); }, product(p), p.active);
    check(pairs);
    const Row still = (pairs.value.array() < p.zero()).count();
    if (ask < most && ask - still < static_cast<Row>(count)) {
      zero = std::max(2 * zero, still);
      continue;
    }
    ModeSet set = mode_set(network, p, pairs, [&](Row k) { return k - still < static_cast<Row>(count); });
    set.zero = static_cast<std::size_t>(still) + (p.total - static_cast<std::size_t>(p.active.sum()));
    set.method = "shift-invert below zero (Cholesky)";
    if (countable && !set.modes.empty()) {
      const double edge = set.modes.back().square * (1 - apart);
      set.complete = Factor(p, edge).below() - still ==
                     std::ranges::count_if(set.modes, [&](const Mode& m) { return m.square < edge; });
    }
    return set;
  }
}

ModeSet highest_modes(const Network& network, std::size_t count) {
  const Problem p = problem_of(network);
  DefiniteInverse inverse(p, p.highest * (1 + 1e-4), -1);
  const Eigenpairs pairs = eigenpairs_near(
      static_cast<Row>(count), [&](const MatrixXd& x, MatrixXd& y) { inverse(x, y); }, product(p), p.active);
  check(pairs);
  ModeSet set = mode_set(network, p, pairs, [](Row) { return true; });
  set.method = "shift-invert above the highest (Cholesky)";
  if (p.a.rows() <= most_counted && !set.modes.empty()) {
    const double edge = set.modes.front().square * (1 + apart);
    set.complete = static_cast<Row>(p.active.sum()) - Factor(p, edge).below() ==
                   std::ranges::count_if(set.modes, [&](const Mode& m) { return m.square > edge; });
  }
  return set;
}

ModeSet modes_between(const Network& network, double low, double high) {
  const Problem p = problem_of(network);
  const auto square = [](double f) { return std::pow(2 * std::numbers::pi * f, 2); };
  const double from = std::max(square(low), p.zero()), to = std::max(square(high), from);
  const double middle = (from + to) / 2;
  const Factor lower(p, from), upper(p, to), inverse(p, middle);
  const Row inside = std::max<Row>(upper.below() - lower.below(), 0);
  const Eigenpairs pairs = eigenpairs_near(
      inside, [&](const MatrixXd& x, MatrixXd& y) { y = inverse.solve(x); }, product(p), p.active);
  check(pairs);
  ModeSet set = mode_set(network, p, pairs, [](Row) { return true; });
  set.complete = static_cast<Row>(set.modes.size()) == inside;
  set.method = "shift-invert at the middle of the window (LDLᵀ)";
  return set;
}

ModeSet all_modes(const Network& network, bool with_shapes) {
  const MatrixXd a = dense_scaled_stiffness(network);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(
      a, with_shapes ? Eigen::ComputeEigenvectors : Eigen::EigenvaluesOnly);
  const auto inverse = inverse_mass_diagonal(network);
  ModeSet set;
  set.method = "dense";
  set.total = static_cast<std::size_t>(std::ranges::count_if(inverse, [](double x) { return x > 0; }));
  const VectorXd& value = solver.eigenvalues();
  const Row first = (value.array() < zero_share * value(value.size() - 1)).count();
  const Row vibrating = value.size() - first;
  set.zero = set.total - static_cast<std::size_t>(vibrating);
  if (with_shapes) set.shapes = solver.eigenvectors().rightCols(vibrating);
  for (Row k = 0; k < vibrating; ++k) {
    if (with_shapes) {
      const VectorXd x = set.shapes.col(k);
      set.modes.push_back(describe(network, value(first + k), (a * x - value(first + k) * x).norm(), x));
    } else {
      set.modes.push_back({.square = value(first + k)});
    }
  }
  return set;
}

}  // namespace eg
