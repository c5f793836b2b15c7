#include "waves/dispersion.hpp"

#include <algorithm>
#include <cmath>

namespace eg {
namespace {

/// ω of the acoustic waves at k, slowest first.
std::vector<double> acoustic(const Network& unit, const Vec3& k) {
  auto modes = bloch_modes(unit, k);
  const auto moved = [](const BlochMode& m) { return m.mean[0] + m.mean[1] + m.mean[2]; };
  std::ranges::stable_sort(modes, [&](const BlochMode& a, const BlochMode& b) { return moved(a) > moved(b); });
  std::vector<double> found;
  for (std::size_t m = 0; m < static_cast<std::size_t>(unit.dimension) && m < modes.size(); ++m)
    found.push_back(std::sqrt(std::max(modes[m].square, 0.0)));
  std::ranges::sort(found);
  return found;
}

}  // namespace

Dispersion dispersion(const Network& unit, const Mat3& edges, const std::vector<ZonePoint>& path, int steps,
                      const std::function<void(double)>& progress) {
  Dispersion out;
  double distance = 0;
  for (std::size_t leg = 0; leg + 1 < path.size(); ++leg) {
    const Vec3 from = wave_vector(edges, path[leg].reduced), to = wave_vector(edges, path[leg + 1].reduced);
    out.corners.push_back(out.points.size());
    const bool last = leg + 2 == path.size();
    for (int s = 0; s < steps + (last ? 1 : 0); ++s) {
      const double share = static_cast<double>(s) / steps;
      const Vec3 k = from + (to - from) * share;
      out.points.push_back({k, distance + norm(to - from) * share, bloch_modes(unit, k)});
      if (progress) progress((static_cast<double>(leg) + share) / static_cast<double>(path.size() - 1));
    }
    distance += norm(to - from);
  }
  out.corners.push_back(out.points.size() - 1);
  return out;
}

std::vector<double> long_wave_speeds(const Network& unit, const Vec3& direction, double edge) {
  const double q = 2e-3 / edge;
  const Vec3 k = direction * (q / norm(direction));
  const auto far = acoustic(unit, k), near = acoustic(unit, k * 0.5);
  std::vector<double> speeds;
  for (std::size_t m = 0; m < far.size(); ++m) {
    const double speed = (8 * near[m] - far[m]) / (3 * q);
    speeds.push_back(far[m] > 1e-4 * far.back() ? speed : 0.0);  // round-off of a wave that nothing resists
  }
  return speeds;
}

}  // namespace eg
