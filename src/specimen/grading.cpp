#include "specimen/grading.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace eg {

namespace {

/// One sieve interval: mass uniform in d on [low, high], so number density ∝ 1/d^D, whose integral −1/((D−1) d^(D−1))
/// is inverted in closed form.
struct Sieve {
  double low, high;  ///< diameters [m]
  double number;     ///< share of the grains by number, not normalised

  static double power(double d, int dimension) { return dimension == 3 ? 1 / (d * d) : 1 / d; }

  Sieve(double low_, double high_, double mass, int dimension)
      : low(low_),
        high(high_),
        number(mass * (power(low, dimension) - power(high, dimension)) / ((high - low) * (dimension - 1))) {}

  /// Diameter below which the fraction u of the interval's grains lies.
  double quantile(double u, int dimension) const {
    const double a = power(low, dimension), p = a - u * (a - power(high, dimension));
    return std::clamp(dimension == 3 ? 1 / std::sqrt(p) : 1 / p, low, high);
  }
};

std::vector<Sieve> sieves(const Grading& grading, int dimension) {
  std::vector<Sieve> all;
  for (std::size_t k = 1; k < grading.passing.size(); ++k) {
    const auto [d0, p0] = grading.passing[k - 1];
    const auto [d1, p1] = grading.passing[k];
    if (p1 > p0) all.emplace_back(d0, d1, p1 - p0, dimension);
  }
  return all;
}

/// Radii at ascending fractions u of the grains by number.
std::vector<double> table_radii(const Grading& grading, int dimension, std::span<const double> fractions) {
  const auto intervals = sieves(grading, dimension);
  assert(!intervals.empty());
  double total = 0;
  for (const auto& sieve : intervals) total += sieve.number;

  std::vector<double> radii;
  radii.reserve(fractions.size());
  std::size_t k = 0;
  double below = 0;  // grains by number in the intervals before k
  for (const double fraction : fractions) {
    while (k + 1 < intervals.size() && below + intervals[k].number < fraction * total) below += intervals[k++].number;
    const double inside = std::clamp((fraction * total - below) / intervals[k].number, 0.0, 1.0);
    radii.push_back(intervals[k].quantile(inside, dimension) / 2);
  }
  return radii;
}

}  // namespace

std::vector<double> draw_radii(const Grading& grading, int dimension, std::size_t count, Random& random) {
  if (grading.kind == Grading::Kind::single) return std::vector<double>(count, grading.min_radius);
  std::vector<double> radii(count);
  for (std::size_t i = 0; i < count; ++i)
    radii[i] = (static_cast<double>(i) + random.uniform()) / static_cast<double>(count);
  if (grading.kind == Grading::Kind::table) {
    radii = table_radii(grading, dimension, radii);
  } else {
    for (double& r : radii) r = grading.min_radius + (grading.max_radius - grading.min_radius) * r;
  }
  for (std::size_t i = count; i > 1; --i) std::swap(radii[i - 1], radii[random.below(i)]);  // Fisher and Yates 1938
  return radii;
}

std::size_t count_with_coarse(const Grading& grading, int dimension, std::size_t coarse) {
  const auto intervals = sieves(grading, dimension);
  double total = 0;
  for (const auto& sieve : intervals) total += sieve.number;
  return static_cast<std::size_t>(std::llround(static_cast<double>(coarse) * total / intervals.back().number));
}

std::vector<double> passing_by_mass(std::span<const double> radii, int dimension, std::span<const double> diameters) {
  std::vector<double> passing(diameters.size());
  double total = 0;
  for (const double r : radii) {
    const double mass = dimension == 3 ? r * r * r : r * r;
    total += mass;
    for (std::size_t k = 0; k < diameters.size(); ++k)
      if (2 * r <= diameters[k]) passing[k] += mass;
  }
  for (double& p : passing) p /= total;
  return passing;
}

}  // namespace eg
