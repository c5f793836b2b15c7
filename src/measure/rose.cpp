#include "measure/rose.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace eg {

namespace {

constexpr double circle = 2 * std::numbers::pi;

/// Equal sectors, the first one around 0, so that the directions of lattices do not lie on edges.
int azimuth_bin(const Vec3& n, int bins) {
  const double sectors = std::atan2(n.y, n.x) / circle * bins;
  return (static_cast<int>(std::floor(sectors + 0.5)) + bins) % bins;
}
double edge(int k, int bins) { return circle * (k - 0.5) / bins; }

/// Petals in place, counted by `bin_of`.
template <class Bin>
std::vector<Petal> count(std::vector<Petal> petals, std::span<const ContactPoint> contacts, Bin bin_of) {
  double ends = 0, force = 0;
  for (const auto& c : contacts) {
    if (c.j == no_index) continue;
    for (const double side : {1.0, -1.0}) {
      auto& petal = petals[static_cast<std::size_t>(bin_of(side * c.geometry.n))];
      ++petal.density, ++ends;
      petal.force += c.normal.force, force += c.normal.force;
    }
  }
  for (auto& p : petals) {
    if (p.density == 0) continue;
    p.force = force > 0 ? p.force / p.density * ends / force : 0;
    p.density *= static_cast<double>(petals.size()) / ends;
  }
  return petals;
}

}  // namespace

std::vector<Petal> rose_2d(std::span<const ContactPoint> contacts, int sectors) {
  std::vector<Petal> petals;
  for (int k = 0; k < sectors; ++k) petals.push_back({edge(k, sectors), edge(k + 1, sectors)});
  return count(petals, contacts, [&](const Vec3& n) { return azimuth_bin(n, sectors); });
}

std::vector<Petal> rose_3d(std::span<const ContactPoint> contacts, int rings) {
  const int around = 2 * rings;
  std::vector<Petal> petals;
  for (int r = 0; r < rings; ++r)
    for (int k = 0; k < around; ++k)
      petals.push_back({edge(k, around), edge(k + 1, around), 2.0 * r / rings - 1, 2.0 * (r + 1) / rings - 1});
  return count(petals, contacts, [&](const Vec3& n) {
    const int ring = std::clamp(static_cast<int>((n.z + 1) / 2 * rings), 0, rings - 1);
    return ring * around + azimuth_bin(n, around);
  });
}

}  // namespace eg
