#include "measure/section.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "measure/volume.hpp"

namespace eg {

namespace {

constexpr double pi = std::numbers::pi;

/// A few numbers in ascending order, those outside a range left out and its ends put in.
template <std::size_t most>
class Breaks {
 public:
  Breaks(double low, double high) : low_(low), high_(high) { push(low), push(high); }
  void add(double value) {
    if (value > low_ && value < high_) push(value);
  }
  void sort() { std::sort(values_.begin(), values_.begin() + count_); }
  std::size_t pieces() const { return count_ - 1; }
  double operator[](std::size_t k) const { return values_[k]; }

 private:
  void push(double value) { values_[static_cast<std::size_t>(count_++)] = value; }
  std::array<double, most + 2> values_{};
  std::ptrdiff_t count_ = 0;
  double low_, high_;
};

/// Half of the disk's chord at x.
double half_chord(double radius, double x) { return std::sqrt(std::max(0.0, (radius - x) * (radius + x))); }

/// Part of a disk outside a circle; a thin sliver keeps its digits, as the difference of the whole would not.
double disk_beyond(double radius, double circle, double distance) {
  const double sliver = radius + distance - circle;
  if (sliver <= 0) return 0;
  if (distance <= std::abs(radius - circle) || distance >= radius + circle)
    return grain_volume(2, radius) - lens_volume(2, radius, circle, distance);
  const double disk_cap = sliver * (radius + distance + circle) / (2 * distance);
  const double circle_cap = sliver * (circle - distance + radius) / (2 * distance);
  return cap_volume(2, radius, radius - disk_cap) - cap_volume(2, circle, circle - circle_cap);
}

/// ½ ∫ ρ² dψ along the edge of a disk as seen from a point at `distance`; ψ from the direction of the disk's centre.
/// With t the angle at the disk's centre, dA = ½ (s² + s d cos t) dt.
double swept(double radius, double distance, double psi, bool far_side) {
  const double beta = std::asin(std::clamp(distance / radius * std::sin(psi), -1.0, 1.0));
  const double t = far_side ? psi + beta : psi + pi - beta;
  return 0.5 * radius * (radius * t + distance * std::sin(t));
}

/// What a disk and a ring have in common between two rays ψ = a and b; no edges cross in between.
double between_rays(double radius, double distance, const Extent& ring, double a, double b) {
  const double turn = 2 * pi * std::round((a + b) / (4 * pi));
  a -= turn, b -= turn;
  const double middle = 0.5 * (a + b), across = distance * std::sin(middle), along = distance * std::cos(middle);
  const double chord2 = (radius - across) * (radius + across);
  if (!(chord2 > 0) || (distance > radius && along < 0)) return 0;
  const double chord = std::sqrt(chord2), nearest = along - chord, farthest = along + chord;
  if (std::max(nearest, ring.low) >= std::min(farthest, ring.high)) return 0;
  const auto edge = [&](bool far_side) {
    return swept(radius, distance, b, far_side) - swept(radius, distance, a, far_side);
  };
  const double outer = farthest <= ring.high ? edge(true) : 0.5 * ring.high * ring.high * (b - a);
  const double inner = nearest > ring.low ? edge(false) : 0.5 * ring.low * ring.low * (b - a);
  return outer - inner;
}

}  // namespace

double disk_in_rectangle(double radius, const Extent& x, const Extent& y) {
  if (!(radius > 0) || !(x.low < x.high) || !(y.low < y.high)) return 0;
  const double from = std::max(x.low, -radius), to = std::min(x.high, radius);
  if (!(from < to)) return 0;
  Breaks<4> breaks(from, to);
  for (const double edge : {y.low, y.high})
    if (std::abs(edge) < radius)
      for (const double sign : {-1., 1.}) breaks.add(sign * half_chord(radius, edge));
  breaks.sort();
  double area = 0;
  for (std::size_t k = 0; k < breaks.pieces(); ++k) {
    const double a = breaks[k], b = breaks[k + 1], chord = half_chord(radius, 0.5 * (a + b));
    if (y.low >= chord || y.high <= -chord) continue;
    const double half = 0.5 * (cap_volume(2, radius, a) - cap_volume(2, radius, b));  // ∫ half_chord
    const double above = y.high < chord ? y.high * (b - a) : half;
    const double below = y.low > -chord ? -y.low * (b - a) : half;
    area += above + below;
  }
  return area;
}

double disk_in_ring(double radius, double distance, const Extent& ring) {
  if (distance + radius <= ring.high) return disk_beyond(radius, ring.low, distance);
  return lens_volume(2, radius, ring.high, distance) - lens_volume(2, radius, ring.low, distance);
}

double disk_in_sector(double radius, double distance, double azimuth, const Extent& ring, const Extent& sector) {
  if (!(radius > 0)) return 0;
  const double from = sector.low - azimuth, to = sector.high - azimuth;
  Breaks<18> breaks(from, to);
  const auto add = [&](double psi) {
    for (double angle = psi + 2 * pi * std::ceil((from - psi) / (2 * pi)); angle < to; angle += 2 * pi)
      breaks.add(angle);
  };
  const auto add_both = [&](double psi) { add(psi), add(-psi); };
  if (distance >= radius) add_both(std::asin(radius / distance));  // tangents
  for (const double edge : {ring.low, ring.high}) {
    const double c = (distance * distance + (edge - radius) * (edge + radius)) / (2 * distance * edge);
    if (std::abs(c) <= 1) add_both(std::acos(c));
  }
  breaks.sort();
  double area = 0;
  for (std::size_t k = 0; k < breaks.pieces(); ++k)
    area += between_rays(radius, distance, ring, breaks[k], breaks[k + 1]);
  return area;
}

}  // namespace eg
