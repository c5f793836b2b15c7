#include "waves/arrival.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace eg {
namespace {

constexpr double pi = std::numbers::pi, nothing = std::numeric_limits<double>::quiet_NaN();

double largest(std::span<const double> u) {
  double most = 0;
  for (const double x : u) most = std::max(most, std::abs(x));
  return most;
}

/// Where a parabola through three values has its top, from the middle one, in steps.
double top_of(double left, double middle, double right) {
  const double bend = left - 2 * middle + right;
  return bend == 0 ? 0 : std::clamp(0.5 * (left - right) / bend, -1.0, 1.0);
}

/// In samples.
double start_of(std::span<const double> u) {
  const double level = 0.05 * largest(u);
  for (std::size_t k = 1; k < u.size(); ++k)
    if (std::abs(u[k]) > level) {
      const double before = std::abs(u[k - 1]);
      return static_cast<double>(k) - (std::abs(u[k]) - level) / (std::abs(u[k]) - before);
    }
  return nothing;
}

double peak_of(std::span<const double> u) {
  const double level = 0.6 * *std::ranges::max_element(u);
  for (std::size_t k = 1; k + 1 < u.size(); ++k)
    if (u[k] > level && u[k] >= u[k - 1] && u[k] > u[k + 1])
      return static_cast<double>(k) + top_of(u[k - 1], u[k], u[k + 1]);
  return nothing;
}

double correlation_lag(std::span<const double> a, std::span<const double> b) {
  const auto n = static_cast<std::ptrdiff_t>(a.size());
  const auto at = [&](std::ptrdiff_t lag) {
    double sum = 0;
    for (std::ptrdiff_t k = 0; k + lag < n; ++k)
      sum += a[static_cast<std::size_t>(k)] * b[static_cast<std::size_t>(k + lag)];
    return sum;
  };
  std::ptrdiff_t best = 0;
  double most = 0;
  for (std::ptrdiff_t lag = 0; lag < n; ++lag)
    if (const double c = at(lag); c > most) most = c, best = lag;
  if (most == 0) return nothing;
  return best == 0 ? 0 : static_cast<double>(best) + top_of(at(best - 1), most, at(best + 1));
}

/// Slope of y over x by least squares, weights w.
double slope(std::span<const double> x, std::span<const double> y, std::span<const double> w) {
  double sw = 0, sx = 0, sy = 0;
  for (std::size_t k = 0; k < x.size(); ++k) sw += w[k], sx += w[k] * x[k], sy += w[k] * y[k];
  double xx = 0, xy = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    xx += w[k] * std::pow(x[k] - sx / sw, 2);
    xy += w[k] * (x[k] - sx / sw) * (y[k] - sy / sw);
  }
  return xx > 0 ? xy / xx : nothing;
}

void unwrap(std::vector<double>& phase) {
  for (std::size_t k = 1; k < phase.size(); ++k) phase[k] -= 2 * pi * std::round((phase[k] - phase[k - 1]) / (2 * pi));
}

double group_delay(const Spectrum& a, const Spectrum& b, double frequency) {
  std::vector<double> omega, phase, weight;
  for (auto k = static_cast<std::size_t>(0.75 * frequency / a.step);
       k <= static_cast<std::size_t>(1.25 * frequency / a.step); ++k) {
    if (k >= a.value.size()) break;
    const auto cross = std::conj(a.value[k]) * b.value[k];
    omega.push_back(2 * pi * a.step * static_cast<double>(k));
    phase.push_back(std::arg(cross));
    weight.push_back(std::abs(cross));
  }
  unwrap(phase);
  return omega.size() < 3 ? nothing : -slope(omega, phase, weight);
}

}  // namespace

std::vector<Arrival> arrivals(const Transmission& test, std::size_t from, std::size_t to, double frequency) {
  const auto& a = test.traces[from];
  const auto& b = test.traces[to];
  const auto later = [&](double (*reading)(std::span<const double>)) {
    return (reading(b.u) - reading(a.u)) * test.interval;
  };
  std::vector<Arrival> list{
      {"start-start", later(start_of), 0},
      {"peak-peak", later(peak_of), 0},
      {"cross-correlation", correlation_lag(a.u, b.u) * test.interval, 0},
      {"phase slope", group_delay(spectrum(a.u, test.interval), spectrum(b.u, test.interval), frequency), 0}};
  for (auto& arrival : list) arrival.speed = arrival.time > 0 ? (b.distance - a.distance) / arrival.time : nothing;
  return list;
}

double phase_speed(const Transmission& test, std::size_t from, std::size_t to, double frequency) {
  std::vector<double> distance, phase, weight;
  for (std::size_t k = from; k <= to; ++k) {
    const auto value = spectrum(test.traces[k].u, test.interval).at(frequency);
    distance.push_back(test.traces[k].distance), phase.push_back(std::arg(value)), weight.push_back(std::abs(value));
  }
  unwrap(phase);
  return distance.size() < 3 ? nothing : -2 * pi * frequency / slope(distance, phase, weight);
}

std::vector<double> response(const Transmission& test, std::size_t from, std::size_t to,
                             std::span<const double> frequencies) {
  const auto of = [&](std::size_t trace) {  // slow waves still go on at the end: faded out, or they would leak
    std::vector<double> u = test.traces[trace].u;
    const auto size = static_cast<double>(u.size());
    for (std::size_t k = u.size() / 2; k < u.size(); ++k)
      u[k] *= std::pow(std::sin(pi * static_cast<double>(k) / size), 2);
    return spectrum(u, test.interval);
  };
  const Spectrum source = of(0), a = of(from), b = of(to);
  double most = 0;
  for (const auto& value : source.value) most = std::max(most, std::abs(value));
  std::vector<double> ratio;
  for (const double f : frequencies)
    ratio.push_back(std::abs(source.at(f)) > 0.03 * most ? std::abs(b.at(f)) / std::abs(a.at(f)) : nothing);
  return ratio;
}

double cutoff(std::span<const double> frequencies, std::span<const double> response) {
  constexpr double half = 0.5, width = 1.1;
  for (std::size_t k = 0; k + 1 < response.size(); ++k) {
    if (!(response[k] >= half && response[k + 1] < half)) continue;
    std::size_t next = k + 1;
    while (next < response.size() && response[next] < half && frequencies[next] < width * frequencies[k]) ++next;
    if (next == response.size() || !(response[next] < half)) continue;
    return std::lerp(frequencies[k], frequencies[k + 1], (response[k] - half) / (response[k] - response[k + 1]));
  }
  return nothing;
}

std::vector<double> ridge(const WaveMap& map) {
  std::vector<double> k;
  for (std::size_t row = 0; row < map.rows; ++row) {
    const auto* begin = map.value.data() + row * map.columns;
    const auto* best = std::max_element(begin, begin + map.columns);
    const auto c = best - begin;
    if (!(*best > 0) || c == 0 || c + 1 == static_cast<std::ptrdiff_t>(map.columns))
      k.push_back(nothing);
    else
      k.push_back(map.k_step * (static_cast<double>(c) + top_of(best[-1], best[0], best[1])));
  }
  return k;
}

}  // namespace eg
