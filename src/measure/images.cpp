#include "measure/images.hpp"

#include <array>
#include <cmath>

namespace eg {

void visit_images(const Cell& cell, const Vec3& point, const Vec3& centre, double reach,
                  const std::function<void(const Vec3& shift)>& visit) {
  std::array<int, 3> low{}, high{};
  const Vec3 away = inverse(cell.h) * (centre - point);  // in edges
  for (int k = 0; k < 3; ++k) {
    const auto place = static_cast<std::size_t>(k);
    if (!cell.periodic[place]) continue;
    const double edges = reach / cell.width(k);
    low[place] = static_cast<int>(std::ceil(away[k] - edges)),
    high[place] = static_cast<int>(std::floor(away[k] + edges));
  }
  for (int a = low[0]; a <= high[0]; ++a)
    for (int b = low[1]; b <= high[1]; ++b)
      for (int c = low[2]; c <= high[2]; ++c) visit(cell.h * Vec3{double(a), double(b), double(c)});
}

}  // namespace eg
