#include "measure/point_grid.hpp"

#include <algorithm>
#include <cmath>

namespace eg {

PointGrid::PointGrid(std::span<const Vec3> points, double spacing) : points_(points), spacing_(spacing) {
  if (points.empty()) {
    begin_ = {0, 0};
    return;
  }
  Vec3 high = low_ = points[0];
  for (const auto& x : points)
    for (int k = 0; k < 3; ++k) low_[k] = std::min(low_[k], x[k]), high[k] = std::max(high[k], x[k]);
  const Vec3 size = high - low_;
  const double most = 8 * static_cast<double>(points.size()) + 64;  // bins, so that sparse points cost no memory
  const auto bins = [&] { return (size.x / spacing_ + 1) * (size.y / spacing_ + 1) * (size.z / spacing_ + 1); };
  while (bins() > most) spacing_ *= 1.3;
  for (int k = 0; k < 3; ++k) count_[static_cast<std::size_t>(k)] = static_cast<std::size_t>(size[k] / spacing_) + 1;
  begin_.assign(count_[0] * count_[1] * count_[2] + 1, 0);
  std::vector<std::size_t> place;
  for (const auto& x : points) {
    const auto b = bin(x);
    place.push_back((b[0] * count_[1] + b[1]) * count_[2] + b[2]);
    ++begin_[place.back() + 1];
  }
  for (std::size_t k = 1; k < begin_.size(); ++k) begin_[k] += begin_[k - 1];
  order_.resize(points.size());
  auto next = begin_;
  for (std::size_t i = 0; i < points.size(); ++i) order_[next[place[i]]++] = i;
}

std::array<std::size_t, 3> PointGrid::bin(const Vec3& x) const {
  std::array<std::size_t, 3> at{};
  for (int k = 0; k < 3; ++k) {
    const auto axis = static_cast<std::size_t>(k);
    const double last = static_cast<double>(count_[axis] - 1);
    at[axis] = static_cast<std::size_t>(std::clamp((x[k] - low_[k]) / spacing_, 0.0, last));
  }
  return at;
}

}  // namespace eg
