#include <algorithm>
#include <limits>

#include "timestep/estimates.hpp"

namespace eg {
namespace {

struct Range {
  double least = std::numeric_limits<double>::infinity(), most = 0, sum = 0;
  std::size_t count = 0;

  void add(double value) {
    least = std::min(least, value);
    most = std::max(most, value);
    sum += value;
    ++count;
  }
  double low() const { return count ? least : 0.0; }
  double mean() const { return count ? sum / static_cast<double>(count) : 0.0; }
};

}  // namespace

std::vector<int> coordination_numbers(const Network& network) {
  std::vector<int> numbers(network.size(), 0);
  for (const Spring& s : network.springs) {
    if (s.couple) continue;
    ++numbers[s.i];
    if (s.j != no_index) ++numbers[s.j];
  }
  return numbers;
}

NetworkSummary summarise(const Network& network) {
  const auto numbers = coordination_numbers(network);
  Range mass, radius, normal, tangential, coordination;
  for (std::size_t g = 0; g < network.size(); ++g) {
    if (network.inverse_mass[g] == 0) continue;
    mass.add(1 / network.inverse_mass[g]);
    radius.add(network.radius[g]);
    coordination.add(numbers[g]);
  }
  for (const Spring& s : network.springs) {
    if (s.couple) continue;
    normal.add(s.normal);
    tangential.add(s.tangential);
  }
  NetworkSummary summary;
  summary.mass_min = mass.low(), summary.mass_max = mass.most, summary.mass_mean = mass.mean();
  summary.radius_min = radius.low(), summary.radius_max = radius.most, summary.radius_mean = radius.mean();
  summary.normal_min = normal.low(), summary.normal_max = normal.most, summary.normal_mean = normal.mean();
  summary.tangential_min = tangential.low(), summary.tangential_max = tangential.most;
  summary.coordination_max = static_cast<int>(coordination.most);
  summary.coordination_mean = coordination.mean();
  summary.movable = mass.count;
  return summary;
}

}  // namespace eg
