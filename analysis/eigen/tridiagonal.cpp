#include "eigen/tridiagonal.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace eg {
namespace {

/// True when every eigenvalue is below σ: all pivots of σ − T are positive.
bool all_below(double sigma, std::span<const double> a, std::span<const double> b) {
  double pivot = sigma - a[0];
  for (std::size_t k = 1; k < a.size() && pivot > 0; ++k) pivot = sigma - a[k] - b[k - 1] * b[k - 1] / pivot;
  return pivot > 0;
}

/// x ← (σ − T)⁻¹x / length. σ − T is positive definite, so no pivoting; its inverse has no negative entry.
void inverse_iterate(double sigma, std::span<const double> a, std::span<const double> b, std::vector<double>& x) {
  const std::size_t n = a.size();
  std::vector<double> pivot(n);
  const double smallest = std::max(std::numeric_limits<double>::epsilon() * std::abs(sigma), 1e-300);
  pivot[0] = std::max(sigma - a[0], smallest);
  for (std::size_t k = 1; k < n; ++k) {
    pivot[k] = std::max(sigma - a[k] - b[k - 1] * b[k - 1] / pivot[k - 1], smallest);
    x[k] += b[k - 1] / pivot[k - 1] * x[k - 1];
  }
  x[n - 1] /= pivot[n - 1];
  for (std::size_t k = n - 1; k-- > 0;) x[k] = (x[k] + b[k] * x[k + 1]) / pivot[k];
  const double largest = *std::max_element(x.begin(), x.end());
  double sum = 0;
  for (double& value : x) value /= largest, sum += value * value;
  for (double& value : x) value /= std::sqrt(sum);
}

}  // namespace

TridiagonalTop tridiagonal_top(std::span<const double> a, std::span<const double> b) {
  const std::size_t n = a.size();
  double low = a[0], high = a[0];
  for (std::size_t k = 0; k < n; ++k) {
    const double row = (k > 0 ? b[k - 1] : 0.0) + (k + 1 < n ? b[k] : 0.0);
    low = std::max(low, a[k]);
    high = std::max(high, a[k] + row);
  }
  high += 4 * std::numeric_limits<double>::epsilon() * std::abs(high);
  for (int k = 0; k < 100; ++k) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) break;
    (all_below(middle, a, b) ? high : low) = middle;
  }
  TridiagonalTop top{high, std::vector<double>(n, 1.0)};
  for (int k = 0; k < 3; ++k) inverse_iterate(high, a, b, top.vector);
  return top;
}

}  // namespace eg
