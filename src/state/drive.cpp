#include "state/drive.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace eg {
namespace {

using Matrix = std::array<Components, 6>;

/// What a condition on stresses is in terms of strains, over K.
Components on_strains(const Components& b, int dimension) {
  const double shear = dimension == 3 ? 0.6 : 0.5;  // C44 = C12; C11 − C12 = 2 C44
  Components a{};
  for (std::size_t k = 0; k < 6; ++k) a[k] = k < 3 ? 2 * shear * b[k] + shear * (b[0] + b[1] + b[2]) : shear * b[k];
  return a;
}

/// Gauss–Jordan on the leading n×n block, rows scaled to 1; nothing is left of m. False when it is singular.
bool invert(Matrix m, std::size_t n, Matrix& out) {
  for (std::size_t r = 0; r < n; ++r) {
    out[r] = {};
    double largest = 0;
    for (std::size_t c = 0; c < n; ++c) largest = std::max(largest, std::abs(m[r][c]));
    if (!(largest > 0)) return false;
    out[r][r] = 1 / largest;
    for (double& x : m[r]) x /= largest;
  }
  for (std::size_t c = 0; c < n; ++c) {
    std::size_t pivot = c;
    for (std::size_t r = c + 1; r < n; ++r)
      if (std::abs(m[r][c]) > std::abs(m[pivot][c])) pivot = r;
    if (!(std::abs(m[pivot][c]) > 1e-9)) return false;
    std::swap(m[c], m[pivot]), std::swap(out[c], out[pivot]);
    const double scale = 1 / m[c][c];
    for (std::size_t k = 0; k < n; ++k) m[c][k] *= scale, out[c][k] *= scale;
    for (std::size_t r = 0; r < n; ++r) {
      const double f = m[r][c];
      if (r == c || f == 0) continue;
      for (std::size_t k = 0; k < n; ++k) m[r][k] -= f * m[c][k], out[r][k] -= f * out[c][k];
    }
  }
  return true;
}

}  // namespace

double weighted(const Components& coefficient, const Components& value) {
  double sum = 0;
  for (std::size_t k = 0; k < 6; ++k) sum += coefficient[k] * value[k];
  return sum;
}

Drive::Drive(const StageSpec& stage, int dimension) {
  using Kind = ComponentControl::Kind;
  for (std::size_t k = 0; k < 6; ++k) {
    const auto& control = stage.control[k];
    if (control.kind != Kind::stress && control.kind != Kind::free) continue;
    unknown_.push_back(k);
    if (control.kind == Kind::free) continue;
    CellCondition target{CellCondition::Quantity::stress, {}, control.value};
    target.coefficient[k] = 1;
    equations_.push_back(target);
  }
  equations_.insert(equations_.end(), stage.hold.begin(), stage.hold.end());
  for (const auto& e : equations_)
    rows_.push_back(e.quantity == CellCondition::Quantity::rate ? e.coefficient : on_strains(e.coefficient, dimension));
  if (rows_.size() != unknown_.size()) return;
  Matrix m{};
  for (std::size_t r = 0; r < rows_.size(); ++r)
    for (std::size_t c = 0; c < unknown_.size(); ++c) m[r][c] = rows_[r][unknown_[c]];
  solvable_ = invert(m, unknown_.size(), inverse_);
}

Components Drive::rates(const Components& known, const Components& right) const {
  Components rate = known;
  for (const std::size_t k : unknown_) rate[k] = 0;
  Components rest{};
  for (std::size_t r = 0; r < rows_.size(); ++r) rest[r] = right[r] - weighted(rows_[r], rate);
  for (std::size_t c = 0; c < unknown_.size(); ++c) rate[unknown_[c]] = weighted(inverse_[c], rest);
  return rate;
}

}  // namespace eg
