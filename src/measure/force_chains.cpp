#include "measure/force_chains.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "measure/contact_network.hpp"
#include "measure/grain_stress.hpp"
#include "measure/tensor.hpp"
#include "measure/volume.hpp"

namespace eg {

namespace {

/// Sets that merge; the smallest member names a set.
class Sets {
 public:
  explicit Sets(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }
  std::size_t find(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) {
    a = find(a), b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::size_t> parent_;
};

/// Major principal stress of a grain and its direction.
struct Major {
  double value = 0;
  Vec3 axis;
};

std::vector<Major> major_stresses(const State& state, std::span<const ContactPoint> contacts) {
  const auto virial = grain_virials(state.grains.size(), contacts);
  std::vector<Major> major;
  for (std::size_t i = 0; i < virial.size(); ++i) {
    const auto p = principal(virial[i], state.dimension);
    major.push_back({p.values[0] / grain_volume(state.dimension, state.grains.radius(i)), p.axes[0]});
  }
  return major;
}

/// Chains of three grains and more, the longest first.
ForceChains chains_of(Sets& sets, std::size_t grains) {
  std::vector<int> members(grains);
  for (std::size_t i = 0; i < grains; ++i) ++members[sets.find(i)];
  std::vector<std::size_t> roots;
  for (std::size_t i = 0; i < grains; ++i)
    if (members[i] >= 3) roots.push_back(i);
  std::ranges::stable_sort(roots, std::ranges::greater{}, [&](std::size_t i) { return members[i]; });
  ForceChains result;
  std::vector<int> number(grains, ForceChains::none);
  for (const auto root : roots) {
    number[root] = static_cast<int>(result.length.size());
    result.length.push_back(members[root]);
  }
  for (std::size_t i = 0; i < grains; ++i) result.chain.push_back(number[sets.find(i)]);
  const double all = std::accumulate(result.length.begin(), result.length.end(), 0.0);
  if (grains > 0) result.grain_share = all / static_cast<double>(grains);
  if (!roots.empty()) result.mean_length = all / static_cast<double>(roots.size());
  return result;
}

}  // namespace

ForceChains force_chains(const State& state, std::span<const ContactPoint> contacts, double angle) {
  const std::size_t grains = state.grains.size();
  const auto major = major_stresses(state, contacts);
  const auto ends = contacts_per_grain(grains, contacts);
  double mean = 0, touching = 0;
  for (std::size_t i = 0; i < grains; ++i)
    if (ends[i] > 0) mean += major[i].value, ++touching;
  if (touching > 0) mean /= touching;

  Sets sets(grains);
  const double along = std::cos(angle) * (1 - 1e-12);
  const auto hands_on = [&](Index grain, const Vec3& n) {
    return major[grain].value > mean && std::abs(dot(major[grain].axis, n)) >= along;
  };
  std::vector<bool> joins;
  for (const auto& c : contacts) {
    joins.push_back(c.j != no_index && hands_on(c.i, c.geometry.n) && hands_on(c.j, c.geometry.n));
    if (joins.back()) sets.join(c.i, c.j);
  }
  ForceChains result = chains_of(sets, grains);
  for (std::size_t k = 0; k < contacts.size(); ++k)
    result.link.push_back(joins[k] ? result.chain[contacts[k].i] : ForceChains::none);
  return result;
}

}  // namespace eg
