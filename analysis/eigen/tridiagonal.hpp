#pragma once
#include <span>
#include <vector>

namespace eg {

struct TridiagonalTop {
  double value = 0;
  std::vector<double> vector;  ///< length 1, all entries ≥ 0
};

/// Largest eigenpair of the symmetric tridiagonal matrix with this diagonal and off-diagonal (> 0, one shorter):
/// bisection by Sturm counts (Wilkinson 1965), then inverse iteration.
TridiagonalTop tridiagonal_top(std::span<const double> diagonal, std::span<const double> off_diagonal);

}  // namespace eg
