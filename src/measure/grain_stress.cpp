#include "measure/grain_stress.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "measure/contact_network.hpp"
#include "measure/tensor.hpp"
#include "measure/volume.hpp"

namespace eg {

namespace {

std::size_t fraction_of(double diameter, std::span<const double> splits) {
  return static_cast<std::size_t>(std::ranges::upper_bound(splits, diameter) - splits.begin());
}

double diameter(const State& state, std::size_t grain) { return 2 * state.grains.radius(grain); }

}  // namespace

std::vector<Mat3> grain_virials(std::size_t grains, std::span<const ContactPoint> contacts) {
  std::vector<Mat3> virial(grains);
  for (const auto& c : contacts) {
    const Mat3 whole = outer(c.force(), c.branch);
    const double share = c.j == no_index ? 1 : c.geometry.arm_i / (c.geometry.arm_i + c.geometry.arm_j);
    virial[c.i] += share * whole;
    if (c.j != no_index) virial[c.j] += (1 - share) * whole;
  }
  return virial;
}

std::vector<SizeFraction> size_fractions(const State& state, std::span<const ContactPoint> contacts, double volume,
                                         std::span<const double> splits) {
  const std::size_t count = state.grains.size();
  const auto ends = contacts_per_grain(count, contacts);
  const auto virial = grain_virials(count, contacts);
  std::vector<SizeFraction> fractions(splits.size() + 1);
  std::vector<double> touching(fractions.size()), bearing(fractions.size()), borne(fractions.size());
  Mat3 whole;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t k = fraction_of(diameter(state, i), splits);
    auto& f = fractions[k];
    ++f.grains;
    f.solid_share += grain_volume(state.dimension, state.grains.radius(i));
    f.stress += (1 / volume) * virial[i];
    whole += (1 / volume) * virial[i];
    touching[k] += ends[i];
    if (ends[i] >= 2) ++bearing[k], borne[k] += ends[i];
  }
  const double solid = solid_volume(state), mean = mean_value(whole, state.dimension);
  for (std::size_t k = 0; k < fractions.size(); ++k) {
    auto& f = fractions[k];
    f.smallest = k == 0 ? 0 : splits[k - 1];
    f.largest = k == splits.size() ? std::numeric_limits<double>::infinity() : splits[k];
    if (f.grains == 0) continue;
    const auto n = static_cast<double>(f.grains);
    f.solid_share /= solid;
    f.coordination = touching[k] / n;
    f.mechanical_coordination = bearing[k] > 0 ? borne[k] / bearing[k] : 0;
    f.rattler_share = 1 - bearing[k] / n;
    f.mean_stress_share = mean != 0 ? mean_value(f.stress, state.dimension) / mean : 0;
    f.stress_ratio = f.mean_stress_share / f.solid_share;
  }
  return fractions;
}

std::vector<std::vector<double>> stress_by_pair(const State& state, std::span<const ContactPoint> contacts,
                                                std::span<const double> splits) {
  const std::size_t n = splits.size() + 1;
  std::vector<std::vector<double>> share(n, std::vector<double>(n));
  double whole = 0;
  for (const auto& c : contacts) {
    if (c.j == no_index) continue;
    const double part = dot(c.force(), c.branch);
    const auto [a, b] =
        std::minmax({fraction_of(diameter(state, c.i), splits), fraction_of(diameter(state, c.j), splits)});
    share[a][b] += part;
    whole += part;
  }
  if (whole != 0)
    for (auto& row : share)
      for (double& s : row) s /= whole;
  return share;
}

std::vector<double> natural_splits(const State& state, int parts) {
  std::vector<double> d(state.grains.size());
  for (std::size_t i = 0; i < d.size(); ++i) d[i] = diameter(state, i);
  std::ranges::sort(d);
  double widest = 1.5;
  std::vector<double> splits;
  for (std::size_t k = 1; k < d.size(); ++k)
    if (d[k] / d[k - 1] >= widest) widest = d[k] / d[k - 1], splits = {std::sqrt(d[k] * d[k - 1])};
  if (!splits.empty()) return splits;
  double passed = 0;
  const double solid = solid_volume(state);
  for (const double x : d) {
    const auto want = static_cast<double>(splits.size() + 1) / parts;
    if (passed >= want * solid && x > (splits.empty() ? d.front() : splits.back())) splits.push_back(x);
    passed += grain_volume(state.dimension, x / 2);
    if (splits.size() + 1 == static_cast<std::size_t>(parts)) break;
  }
  return splits;
}

}  // namespace eg
