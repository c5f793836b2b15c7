#include "eigen/inverse_krylov.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "base/random.hpp"

namespace eg {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The growing basis V and H = Vᵀ (A − σ)⁻¹ V.
class Space {
 public:
  Space(Index rows, Index room, const VectorXd& active, std::uint64_t seed)
      : v_(rows, room), h_(MatrixXd::Zero(room, room)), active_(active), random_(seed) {}

  Index size() const { return size_; }
  Index last_block() const { return last_; }
  auto basis() const { return v_.leftCols(size_); }
  auto projected() const { return h_.topLeftCorner(size_, size_); }

  /// A block of random vectors behind what is there.
  void add_random(Index block) {
    MatrixXd x(v_.rows(), block);
    for (Index c = 0; c < block; ++c)
      for (Index r = 0; r < x.rows(); ++r) x(r, c) = active_(r) * random_.normal();
    append(x, x.colwise().norm().transpose());
  }

  /// One more block: the inverse of the last one, cleared of all that is there. False when the space is exhausted.
  bool expand(const BlockMap& inverse) {
    const Index from = size_ - last_;
    MatrixXd y;
    inverse(v_.middleCols(from, last_), y);
    const MatrixXd h = basis().transpose() * y;
    h_.block(0, from, size_, last_) = h;
    h_.block(from, 0, last_, size_) = h.transpose();
    const VectorXd before = y.colwise().norm().transpose();
    y -= basis() * h;
    return append(y, before);
  }

  /// Keeps the combinations `s` of the basis (with their values in H) and, if wanted, the newest block behind them.
  void restart(const MatrixXd& s, const VectorXd& values, bool with_newest) {
    const MatrixXd kept = v_.leftCols(s.rows()) * s;
    const Index newest = with_newest ? last_ : 0;
    const MatrixXd behind = v_.middleCols(size_ - newest, newest);
    h_.setZero();
    h_.topLeftCorner(values.size(), values.size()) = values.asDiagonal();
    v_.leftCols(values.size()) = kept;
    v_.middleCols(values.size(), newest) = behind;
    size_ = values.size() + newest;
    last_ = newest;
  }

 private:
  /// Makes columns orthogonal to the basis and to each other; those of which nothing but round-off of the length
  /// `before` is left are dropped.
  bool append(const MatrixXd& x, const VectorXd& before) {
    last_ = 0;
    for (Index c = 0; c < x.cols() && size_ < v_.cols(); ++c) {
      VectorXd y = x.col(c);
      double least = 1e-12 * before(c);
      bool good = true;
      for (int pass = 0; pass < 3 && good; ++pass) {
        y -= basis() * (basis().transpose() * y);
        const double length = y.norm();
        good = length > least;
        if (good) y /= length;
        least = 0.5;
      }
      if (!good) continue;
      v_.col(size_++) = y;
      ++last_;
    }
    return last_ > 0;
  }

  MatrixXd v_, h_;
  const VectorXd& active_;
  Random random_;
  Index size_ = 0, last_ = 0;
};

/// Ritz pairs of the part of the space whose inverse is known, largest modulus first.
struct Ritz {
  VectorXd value;
  MatrixXd s;
};

Ritz ritz_of(const MatrixXd& h) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(h);
  std::vector<Index> order(static_cast<std::size_t>(h.rows()));
  std::iota(order.begin(), order.end(), Index{0});
  std::ranges::stable_sort(
      order, [&](Index a, Index b) { return std::abs(solver.eigenvalues()(a)) > std::abs(solver.eigenvalues()(b)); });
  Ritz ritz{VectorXd(h.rows()), MatrixXd(h.rows(), h.rows())};
  for (Index k = 0; k < h.rows(); ++k) {
    ritz.value(k) = solver.eigenvalues()(order[static_cast<std::size_t>(k)]);
    ritz.s.col(k) = solver.eigenvectors().col(order[static_cast<std::size_t>(k)]);
  }
  return ritz;
}

Eigenpairs finish(const MatrixXd& vectors, const BlockMap& matrix) {
  Eigenpairs out;
  MatrixXd product;
  matrix(vectors, product);
  const VectorXd value = vectors.cwiseProduct(product).colwise().sum().transpose();
  std::vector<Index> order(static_cast<std::size_t>(value.size()));
  std::iota(order.begin(), order.end(), Index{0});
  std::ranges::stable_sort(order, {}, [&](Index k) { return value(k); });
  out.value.resize(value.size()), out.residual.resize(value.size()), out.vectors.resize(vectors.rows(), value.size());
  for (Index k = 0; k < value.size(); ++k) {
    const Index from = order[static_cast<std::size_t>(k)];
    out.value(k) = value(from);
    out.vectors.col(k) = vectors.col(from);
    out.residual(k) = (product.col(from) - value(from) * vectors.col(from)).norm();
  }
  return out;
}

}  // namespace

Eigenpairs eigenpairs_near(Index count, const BlockMap& inverse, const BlockMap& matrix, const VectorXd& active,
                           const InverseKrylovOptions& options) {
  const auto rows = static_cast<Index>(std::lround(active.sum()));
  count = std::min(count, rows);
  if (count == 0) return {{}, {}, {}, 0, true};
  const Index block = std::min<Index>(options.block, rows);
  const Index room = std::min(rows, 2 * count + 4 * block + 20) + block;
  Space space(active.size(), room, active, options.seed);
  space.add_random(block);
  int solves = 0;
  VectorXd before;  // the values that a converged search found
  for (int restart = 0;; ++restart) {
    bool more = true;
    while (more && (space.size() + block <= room || space.size() >= rows)) {
      solves += static_cast<int>(space.last_block());
      more = space.expand(inverse);
    }
    const Index known = space.size() - space.last_block();
    const Ritz ritz = ritz_of(space.projected().topLeftCorner(known, known));
    const Index found = std::min(count, known);
    const VectorXd values = ritz.value.head(found);
    const MatrixXd wanted = space.basis().leftCols(known) * ritz.s.leftCols(found);
    MatrixXd image;
    inverse(wanted, image);
    solves += static_cast<int>(found);
    const VectorXd residual = (image - wanted * values.asDiagonal()).colwise().norm().transpose();
    const bool converged = (residual.array() <= options.tolerance * values.array().abs()).all();
    const bool whole = space.size() >= rows;
    const bool again = before.size() == found && (values - before).norm() <= 1e-8 * before.norm();
    if ((converged && (whole || again)) || restart == options.max_restarts) {
      Eigenpairs out = finish(wanted, matrix);
      out.solves = solves, out.converged = converged;
      return out;
    }
    if (converged) {
      before = values;
      space.restart(ritz.s.leftCols(found), values, false);
      space.add_random(block);
    } else {
      const Index keep = std::min(count + block, known);
      space.restart(ritz.s.leftCols(keep), ritz.value.head(keep), true);
      if (space.last_block() == 0) space.add_random(block);
    }
  }
}

}  // namespace eg
