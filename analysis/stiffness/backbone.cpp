#include "stiffness/backbone.hpp"

#include <algorithm>

namespace eg {
namespace {

/// The spring as its movable grain sees it; false when neither can move.
bool ground(const Network& network, Spring& s) {
  const auto fixed = [&](Index g) { return g == no_index || !(network.inverse_mass[g] > 0); };
  if (fixed(s.i) && fixed(s.j)) return false;
  if (fixed(s.i)) {
    std::swap(s.i, s.j);
    std::swap(s.arm_i, s.arm_j);
    s.n = -s.n;
  }
  if (fixed(s.j)) s.j = no_index;
  return true;
}

}  // namespace

BackboneNetwork backbone(const Network& network) {
  BackboneNetwork result{network, 0};
  auto& springs = result.network.springs;
  std::erase_if(springs, [&](Spring& s) { return !ground(network, s); });
  std::vector<int> ends;
  for (std::size_t before = springs.size() + 1; springs.size() < before;) {
    before = springs.size();
    ends.assign(network.size(), 0);
    for (const Spring& s : springs) {
      if (s.couple) continue;
      ++ends[s.i];
      if (s.j != no_index) ++ends[s.j];
    }
    std::erase_if(springs, [&](const Spring& s) { return ends[s.i] < 2 || (s.j != no_index && ends[s.j] < 2); });
  }
  for (std::size_t g = 0; g < network.size(); ++g) result.rattlers += network.inverse_mass[g] > 0 && ends[g] < 2;
  return result;
}

}  // namespace eg
