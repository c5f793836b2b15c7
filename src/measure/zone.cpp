#include "measure/zone.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "measure/quadrature.hpp"
#include "measure/volume.hpp"

namespace eg {

namespace {

constexpr double pi = std::numbers::pi;

Extent shifted(const Extent& r, double by) { return {r.low - by, r.high - by}; }
bool covers(const Extent& r, double radius) { return r.low <= -radius && r.high >= radius; }
bool misses(const Extent& r, double radius) { return r.low >= radius || r.high <= -radius || r.low >= r.high; }
bool full_turn(const Extent& angle) { return angle.length() >= 2 * pi * (1 - 1e-15); }

/// Part of a sphere (2D: disk) around the origin between two planes.
double slab(int dimension, double radius, const Extent& range) {
  const double a = std::max(range.low, -radius), b = std::min(range.high, radius);
  if (!(a < b)) return 0;
  const auto cap = [&](double height) { return cap_volume(dimension, radius, height); };
  if (a >= 0) return cap(a) - cap(b);
  if (b <= 0) return cap(-b) - cap(-a);
  return grain_volume(dimension, radius) - cap(-a) - cap(b);
}

/// ∫ section(s) dz over a sphere around the origin, s(z) the radius of its cross-section; `touches`: values of s at
/// which the section's edges touch, where it is not smooth.
template <class Section>
double integrate_sections(double radius, const Extent& height, std::span<const double> touches,
                          const Section& section) {
  const double from = std::max(height.low, -radius), to = std::min(height.high, radius);
  if (!(from < to)) return 0;
  std::vector<double> breaks{from, to};
  const auto add = [&](double z) {
    if (z > from && z < to) breaks.push_back(z);
  };
  add(0);
  for (const double s : touches) {
    if (!(s < radius)) continue;
    const double z = std::sqrt((radius - s) * (radius + s));
    add(z), add(-z);
  }
  std::sort(breaks.begin(), breaks.end());
  double sum = 0;
  for (std::size_t k = 0; k + 1 < breaks.size(); ++k)
    sum += integrate(breaks[k], breaks[k + 1],
                     [&](double z) { return section(std::sqrt(std::max(0.0, (radius - z) * (radius + z)))); });
  return sum;
}

/// Distance of a point at polar (distance, azimuth) from the ray at `angle` out of the origin.
double distance_from_ray(double distance, double azimuth, double angle) {
  const double psi = azimuth - angle;
  return std::cos(psi) > 0 ? distance * std::abs(std::sin(psi)) : distance;
}

bool in_sector(double azimuth, const Extent& sector) {
  const double from_low = azimuth - sector.low;
  return from_low - 2 * pi * std::floor(from_low / (2 * pi)) < sector.length();
}

/// Where a grain stands in a cylinder.
struct Polar {
  double distance, azimuth;
  explicit Polar(const Vec3& p) : distance(std::hypot(p.x, p.y)), azimuth(std::atan2(p.y, p.x)) {}
};

enum class Place { outside, cut, inside };

/// Where a disk stands to the ring and the sector.
Place place_of(const CylinderZone& zone, const Polar& at, double radius) {
  if (at.distance - radius >= zone.radius.high || at.distance + radius <= zone.radius.low) return Place::outside;
  bool whole =
      at.distance + radius <= zone.radius.high && (zone.radius.low <= 0 || at.distance - radius >= zone.radius.low);
  if (!full_turn(zone.angle)) {
    const double clear = std::min(distance_from_ray(at.distance, at.azimuth, zone.angle.low),
                                  distance_from_ray(at.distance, at.azimuth, zone.angle.high));
    if (clear < radius)
      whole = false;
    else if (!in_sector(at.azimuth, zone.angle))
      return Place::outside;
  }
  return whole ? Place::inside : Place::cut;
}

/// Radii of disks around the grain that touch an edge or a corner of ring and sector.
std::vector<double> touching_radii(const CylinderZone& zone, const Polar& at) {
  std::vector<double> radii;
  for (const double edge : {zone.radius.low, zone.radius.high})
    if (std::isfinite(edge)) radii.insert(radii.end(), {std::abs(edge - at.distance), edge + at.distance});
  if (full_turn(zone.angle)) return radii;
  radii.push_back(at.distance);
  for (const double ray : {zone.angle.low, zone.angle.high}) {
    const double along = at.distance * std::cos(at.azimuth - ray), across = at.distance * std::sin(at.azimuth - ray);
    radii.push_back(std::abs(across));
    for (const double edge : {zone.radius.low, zone.radius.high})
      if (std::isfinite(edge)) radii.push_back(std::hypot(along - edge, across));
  }
  return radii;
}

}  // namespace

double volume_of(const BoxZone& zone, int dimension) {
  return zone.x.length() * zone.y.length() * (dimension == 3 ? zone.z.length() : 1);
}

double volume_of(const CylinderZone& zone, int dimension) {
  const auto& r = zone.radius;
  return 0.5 * zone.angle.length() * r.length() * (r.high + r.low) * (dimension == 3 ? zone.height.length() : 1);
}

bool holds(const BoxZone& zone, int dimension, const Vec3& p) {
  return zone.x.holds(p.x) && zone.y.holds(p.y) && (dimension == 2 || zone.z.holds(p.z));
}

bool holds(const CylinderZone& zone, int dimension, const Vec3& p) {
  const Polar at(p);
  return zone.radius.holds(at.distance) && (full_turn(zone.angle) || in_sector(at.azimuth, zone.angle)) &&
         (dimension == 2 || zone.height.holds(p.z));
}

double volume_inside(const BoxZone& zone, int dimension, const Vec3& centre, double radius) {
  const Extent x = shifted(zone.x, centre.x), y = shifted(zone.y, centre.y);
  const Extent z = dimension == 3 ? shifted(zone.z, centre.z) : Extent{};
  if (misses(x, radius) || misses(y, radius) || misses(z, radius)) return 0;
  const bool all_x = covers(x, radius), all_y = covers(y, radius), all_z = covers(z, radius);
  if (all_x && all_y) return slab(dimension, radius, z);
  if (all_y && all_z) return slab(dimension, radius, x);
  if (all_x && all_z) return slab(dimension, radius, y);
  if (dimension == 2) return disk_in_rectangle(radius, x, y);
  std::vector<double> touches;
  for (const double a : {x.low, x.high}) {
    touches.push_back(std::abs(a));
    for (const double b : {y.low, y.high}) touches.insert(touches.end(), {std::abs(b), std::hypot(a, b)});
  }
  return integrate_sections(radius, z, touches, [&](double s) { return disk_in_rectangle(s, x, y); });
}

double volume_inside(const CylinderZone& zone, int dimension, const Vec3& centre, double radius) {
  const Extent height = dimension == 3 ? shifted(zone.height, centre.z) : Extent{};
  const Polar at(centre);
  if (misses(height, radius) || zone.radius.length() <= 0 || zone.angle.length() <= 0) return 0;
  const Place place = place_of(zone, at, radius);
  if (place == Place::outside) return 0;
  if (place == Place::inside) return slab(dimension, radius, height);
  const auto section = [&](double s) {
    return full_turn(zone.angle) ? disk_in_ring(s, at.distance, zone.radius)
                                 : disk_in_sector(s, at.distance, at.azimuth, zone.radius, zone.angle);
  };
  if (dimension == 2) return section(radius);
  return integrate_sections(radius, height, touching_radii(zone, at), section);
}

}  // namespace eg
