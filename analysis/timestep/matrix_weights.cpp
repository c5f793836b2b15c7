#include "timestep/matrix_weights.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "timestep/block_power.hpp"

namespace eg {
namespace {

using Matrix3 = Eigen::Matrix3d;
constexpr double widest_log = 7;

template <class Function>
Matrix3 spectral(const Matrix3& matrix, Function function) {
  const Eigen::SelfAdjointEigenSolver<Matrix3> solver(matrix);
  return solver.eigenvectors() * solver.eigenvalues().unaryExpr(function).asDiagonal() *
         solver.eigenvectors().transpose();
}

/// k^½ = √kt 1 + (√kn − √kt) nnᵀ
Matrix3 stiffness_root(const Spring& s) {
  const Eigen::Vector3d n(s.n.x, s.n.y, s.n.z);
  const double root = std::sqrt(s.tangential);
  return root * Matrix3::Identity() + (std::sqrt(s.normal) - root) * n * n.transpose();
}

/// ln of (A⁻¹ # B) = L^−ᵀ (LᵀBL)^½ L⁻¹, A = LLᵀ.
Matrix3 log_geometric_mean(const Matrix3& a, const Matrix3& b) {
  const Eigen::LLT<Matrix3> cholesky(a);
  const Matrix3 l = cholesky.matrixL();
  const Matrix3 root = spectral(l.transpose() * b * l, [](double x) { return std::sqrt(std::max(x, 0.0)); });
  Matrix3 mean = l.transpose().triangularView<Eigen::Upper>().solve(root);
  mean = l.transpose().triangularView<Eigen::Upper>().solve(mean.transpose()).eval();
  return spectral(0.5 * (mean + mean.transpose()), [](double x) { return std::log(std::max(x, 1e-300)); });
}

/// A matrix near singular carries no wish about the weak directions: they are held at a millionth of its trace.
Matrix3 regular(Matrix3 a, double trace) {
  a /= trace;
  return a + 1e-6 * Matrix3::Identity();
}

}  // namespace

WeightedContacts::WeightedContacts(const Sides& sides, SplittingWeights weights) : sides_(sides) {
  set_weights(std::move(weights));
}

void WeightedContacts::set_weights(SplittingWeights weights) {
  weights_ = std::move(weights);
  matrix_of_.assign(sides_.network().springs.size(), no_index);
  pairs_.resize(weights_.matrix_spring.size());
  for (std::size_t m = 0; m < pairs_.size(); ++m) {
    matrix_of_[weights_.matrix_spring[m]] = static_cast<Index>(m);
    refresh(m);
  }
  grains_.clear();
  for (const Index c : weights_.matrix_spring)
    for (const Index g : {sides_.network().springs[c].i, sides_.network().springs[c].j})
      if (g != no_index) grains_.push_back(g);
  std::sort(grains_.begin(), grains_.end());
  grains_.erase(std::unique(grains_.begin(), grains_.end()), grains_.end());
}

Matrix3 WeightedContacts::weighted_stiffness(const Side& side) const {
  const Matrix3 k = contact_stiffness(sides_.network().springs[side.spring]);
  if (side.role == Side::Role::alone) return k;
  const bool first = side.role == Side::Role::first;
  if (const Index m = matrix_of_[side.spring]; m != no_index) return first ? pairs_[m].first : pairs_[m].second;
  const double t = weights_.scalar[side.spring];
  return (1 + (first ? t : 1 / t)) * k;
}

void WeightedContacts::refresh(std::size_t matrix) {
  const Eigen::SelfAdjointEigenSolver<Matrix3> solver(weights_.log_matrix[matrix]);
  const Eigen::Vector3d log_t = solver.eigenvalues();
  const Matrix3& v = solver.eigenvectors();
  // The proof needs [T −1; −1 T⁻¹] ≥ 0 of the numbers as rounded: both are inflated by their condition times a few ε.
  const double inflate = 1 + 64 * std::numeric_limits<double>::epsilon() * std::exp(log_t(2) - log_t(0));
  const Matrix3 t = inflate * (v * log_t.array().exp().matrix().asDiagonal() * v.transpose());
  const Matrix3 inverse = inflate * (v * (-log_t.array()).exp().matrix().asDiagonal() * v.transpose());
  const Spring& spring = sides_.network().springs[weights_.matrix_spring[matrix]];
  const Matrix3 root = stiffness_root(spring), k = contact_stiffness(spring);
  pairs_[matrix] = {k + root * t * root, k + root * inverse * root};
}

void WeightedContacts::make_matrices(const std::vector<double>& lambda, double hot) {
  const double threshold = hot * *std::max_element(lambda.begin(), lambda.end());
  SplittingWeights next{weights_.scalar, {}, {}};
  const auto& springs = sides_.network().springs;
  for (std::size_t c = 0; c < springs.size(); ++c) {
    const Index m = matrix_of_[c];
    if (m == no_index && !(sides_.is_split(c) && std::max(lambda[springs[c].i], lambda[springs[c].j]) >= threshold))
      continue;
    next.matrix_spring.push_back(static_cast<Index>(c));
    next.log_matrix.push_back(m != no_index ? weights_.log_matrix[m]
                                            : Matrix3(std::log(weights_.scalar[c]) * Matrix3::Identity()));
  }
  set_weights(std::move(next));
}

void WeightedContacts::sweep(int squarings) {
  const auto& springs = sides_.network().springs;
  std::vector<BlockPower> power(grains_.size(), BlockPower(Block::Zero()));
  const auto size = static_cast<std::ptrdiff_t>(grains_.size());
#pragma omp parallel for schedule(static) if (size > 256)
  for (std::ptrdiff_t k = 0; k < size; ++k) {
    BlockPower p(block(grains_[static_cast<std::size_t>(k)]));
    for (int s = 0; s < squarings; ++s) p.square();
    power[static_cast<std::size_t>(k)] = p;
  }
  const auto power_of = [&](Index grain) -> const BlockPower& {
    return power[static_cast<std::size_t>(std::lower_bound(grains_.begin(), grains_.end(), grain) - grains_.begin())];
  };

  const double step = std::min(0.3, 2 / (std::exp2(squarings) + 1));
  const auto count = static_cast<std::ptrdiff_t>(pairs_.size());
#pragma omp parallel for schedule(static) if (count > 256)
  for (std::ptrdiff_t k = 0; k < count; ++k) {
    const auto m = static_cast<std::size_t>(k);
    const Index c = weights_.matrix_spring[m];
    const Spring& spring = springs[c];
    const Matrix3 root = stiffness_root(spring);
    const BlockPower &pi = power_of(spring.i), &pj = power_of(spring.j);
    const Eigen::Matrix<double, 3, 6> ai =
        root * sides_.scaled_matrix(spring.i, {c, Side::Role::first, ContactSide::first, false});
    const Eigen::Matrix<double, 3, 6> aj =
        root * sides_.scaled_matrix(spring.j, {c, Side::Role::second, ContactSide::second, false});
    const Matrix3 a = ai * pi.matrix * ai.transpose(), b = aj * pj.matrix * aj.transpose();
    const double trace_a = a.trace(), trace_b = b.trace();
    if (!(trace_a > 0 && trace_b > 0)) continue;
    Matrix3 wish = log_geometric_mean(regular(a, trace_a), regular(b, trace_b));
    wish += 0.5 * (pj.log_scale + std::log(trace_b) - pi.log_scale - std::log(trace_a)) * Matrix3::Identity();
    const Matrix3 moved = weights_.log_matrix[m] + step * (wish - weights_.log_matrix[m]);
    weights_.log_matrix[m] = spectral(moved, [](double x) { return std::clamp(x, -widest_log, widest_log); });
    refresh(m);
  }
}

void WeightedContacts::update(BlockRanges& ranges) const {
  const auto size = static_cast<std::ptrdiff_t>(grains_.size());
#pragma omp parallel for schedule(static) if (size > 256)
  for (std::ptrdiff_t k = 0; k < size; ++k) {
    const Index g = grains_[static_cast<std::size_t>(k)];
    const Block sum = block(g);
    BlockPower power(sum);
    for (int s = 0; s < 5; ++s) power.square();
    ranges.low[g] = power.trace_ratio(sum);
    ranges.high[g] = power.trace_root() * (1 + 1e-10);
  }
}

SplittingBound WeightedContacts::bound(const BlockRanges& ranges) const {
  SplittingBound maximum;
  std::vector<Index> candidates;
  const double least = ranges.low.empty() ? 0 : *std::max_element(ranges.low.begin(), ranges.low.end());
  for (std::size_t g = 0; g < sides_.size(); ++g)
    if (!sides_.of(g).empty() && ranges.high[g] >= least) candidates.push_back(static_cast<Index>(g));
  std::stable_sort(candidates.begin(), candidates.end(),
                   [&](Index a, Index b) { return ranges.low[a] > ranges.low[b]; });
  for (const Index g : candidates) {
    const std::size_t terms = sides_.of(g).size();
    if (ranges.high[g] < maximum.value) continue;
    const Block sum = block(g);
    if (block_is_below(sum, terms, maximum.value)) continue;
    const double value = block_upper_bound(sum, terms);
    if (value > maximum.value) maximum.value = value, maximum.grain = g;
  }
  return maximum;
}

}  // namespace eg
