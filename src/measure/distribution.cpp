#include "measure/distribution.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "measure/contact_network.hpp"

namespace eg {

std::size_t Histogram::total() const { return std::accumulate(count.begin(), count.end(), below + above); }

double Histogram::density(std::size_t bin) const {
  const auto all = static_cast<double>(total());
  return all > 0 ? static_cast<double>(count[bin]) / (all * width) : 0;
}

Histogram histogram(std::span<const double> values, double low, double high, std::size_t bins) {
  Histogram h;
  h.low = low, h.width = (high - low) / static_cast<double>(bins);
  h.count.resize(bins);
  for (const double x : values) {
    const double place = (x - low) / h.width;
    if (place < 0)
      ++h.below;
    else if (place >= static_cast<double>(bins))
      ++h.above;
    else
      ++h.count[static_cast<std::size_t>(place)];
  }
  return h;
}

std::vector<std::size_t> connectivity(std::size_t grains, std::span<const ContactPoint> contacts) {
  const auto ends = contacts_per_grain(grains, contacts);
  std::vector<std::size_t> count(ends.empty() ? 0 : static_cast<std::size_t>(*std::ranges::max_element(ends)) + 1);
  for (const int n : ends) ++count[static_cast<std::size_t>(n)];
  return count;
}

Histogram normal_forces(std::span<const ContactPoint> contacts) {
  std::vector<double> force;
  for (const auto& c : contacts) force.push_back(c.normal.force);
  const double mean =
      std::accumulate(force.begin(), force.end(), 0.0) / static_cast<double>(std::max<std::size_t>(1, force.size()));
  if (mean > 0)
    for (double& f : force) f /= mean;
  return histogram(force, 0, 8, 80);
}

Spins spins(const State& state) {
  Spins result;
  std::vector<Vec3> turning;
  for (const Quad& spin : state.grains.spin)
    if (spin.w > 0) turning.push_back(spin.vec());
  const double count = static_cast<double>(turning.size());
  for (const auto& w : turning) result.mean += (1 / count) * w, result.largest = std::max(result.largest, norm(w));
  double square = 0;
  for (auto& w : turning) w -= result.mean, square += dot(w, w);
  if (!turning.empty()) result.deviation = std::sqrt(square / count);
  const int first = state.dimension == 3 ? 0 : 2;
  const double one = result.deviation / std::sqrt(3.0 - first);  // of one component
  std::vector<double> scaled;
  for (const auto& w : turning)
    for (int k = first; k < 3 && one > 0; ++k) scaled.push_back(w[k] / one);
  for (const double x : scaled) result.kurtosis += x * x * x * x / static_cast<double>(scaled.size());
  result.scaled = histogram(scaled, -5, 5, 50);
  return result;
}

}  // namespace eg
