#include "eigen/single_basis.hpp"

#include <algorithm>

namespace eg::detail {

void SingleBasis::push(std::span<const double> v) {
  if (room_ == 0) return;
  if ((vectors_.size() + 1) * v.size() > room_) {
    room_ = 0;
    vectors_ = {};
    return;
  }
  vectors_.emplace_back(v.size());
  std::transform(v.begin(), v.end(), vectors_.back().begin(), [](double x) { return static_cast<float>(x); });
}

std::vector<double> SingleBasis::combine(std::span<const double> weights) const {
  std::vector<double> sum(vectors_.front().size(), 0.0);
  constexpr std::ptrdiff_t piece = 2048;  // stays in the first cache while the vectors pass by
  const auto size = static_cast<std::ptrdiff_t>(sum.size()), pieces = (size + piece - 1) / piece;
#pragma omp parallel for schedule(static) if (pieces > 8)
  for (std::ptrdiff_t p = 0; p < pieces; ++p) {
    const std::ptrdiff_t end = std::min(size, (p + 1) * piece);
    for (std::size_t k = 0; k < weights.size(); ++k)
      for (std::ptrdiff_t i = p * piece; i < end; ++i)
        sum[static_cast<std::size_t>(i)] += weights[k] * static_cast<double>(vectors_[k][static_cast<std::size_t>(i)]);
  }
  return sum;
}

}  // namespace eg::detail
