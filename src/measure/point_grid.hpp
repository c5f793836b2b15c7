#pragma once
// Points in bins, to find those near a place.
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "base/vec.hpp"

namespace eg {

class PointGrid {
 public:
  /// Bins of `spacing` > 0 [m], the typical distance that will be asked for. The points must outlive the grid.
  PointGrid(std::span<const Vec3> points, double spacing);

  /// Calls visit(number of the point) for every point within `distance` of x, in a fixed order.
  template <class Visit>
  void near(const Vec3& x, double distance, const Visit& visit) const {
    const auto low = bin(x - Vec3{distance, distance, distance}), high = bin(x + Vec3{distance, distance, distance});
    for (auto a = low[0]; a <= high[0]; ++a)
      for (auto b = low[1]; b <= high[1]; ++b)
        for (auto c = low[2]; c <= high[2]; ++c) {
          const auto place = (a * count_[1] + b) * count_[2] + c;
          for (auto k = begin_[place]; k < begin_[place + 1]; ++k)
            if (norm(points_[order_[k]] - x) <= distance) visit(order_[k]);
        }
  }

 private:
  std::array<std::size_t, 3> bin(const Vec3& x) const;  ///< the nearest one for places outside

  std::span<const Vec3> points_;
  Vec3 low_;
  double spacing_;
  std::array<std::size_t, 3> count_{1, 1, 1};
  std::vector<std::size_t> begin_, order_;
};

}  // namespace eg
