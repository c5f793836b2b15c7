#include "state/wall_geometry.hpp"

#include <tuple>

namespace eg {

bool over_face(const Wall& face, const Vec3& x) {
  const std::array<Vec3, 3> corner{face.point, face.point + face.side_b, face.point + face.side_c};
  for (std::size_t k = 0; k < 3; ++k) {
    Vec3 a = corner[k], b = corner[(k + 1) % 3];
    const bool turned = std::tie(b.x, b.y, b.z) < std::tie(a.x, a.y, a.z);
    if (turned) std::swap(a, b);
    double side = dot(cross(b - a, x - a), face.normal);
    if (turned) side = -side;
    if (side < 0 || (side == 0 && (face.owned >> k & 1) == 0)) return false;
  }
  return true;
}

bool off_rim(const Wall& rim, const Vec3& x) {
  const Vec3 from = x - rim.point;
  const double s = dot(from, rim.normal);
  return s > 0 && s < rim.length && dot(from, rim.side_b) <= 0 && dot(from, rim.side_c) <= 0;
}

bool off_tip(const Wall& tip, const std::vector<Vec3>& spokes, const Vec3& x) {
  for (Index k = tip.spoke; k < tip.spoke + tip.spokes; ++k)
    if (dot(x - tip.point, spokes[k]) > 0) return false;
  return true;
}

}  // namespace eg
