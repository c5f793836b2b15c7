#include "dynamics/bonds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/random.hpp"

namespace eg {
namespace {

/// x_j − x_i to the nearest image of j.
Vec3 nearest(const State& state, const Mat3& inverse_cell, Index i, Index j) {
  const Vec3 branch = state.grains.position[j].vec() - state.grains.position[i].vec();
  Vec3 s = inverse_cell * branch;
  for (int k = 0; k < 3; ++k) s[k] = state.cell.periodic[static_cast<std::size_t>(k)] ? std::round(s[k]) : 0.0;
  return branch - state.cell.h * s;
}

/// Number of the cluster of every grain. Centres are drawn by id, so that the order of grains does not matter.
std::vector<Index> clusters_of(const State& state, std::size_t clusters, std::uint64_t seed) {
  const std::size_t n = state.grains.size();
  std::vector<Index> centres(n);
  std::iota(centres.begin(), centres.end(), Index{0});
  std::ranges::sort(centres, {}, [&](Index i) { return state.grains.id[i]; });
  Random random(seed);
  clusters = std::min(clusters, n);
  for (std::size_t k = 0; k < clusters; ++k) std::swap(centres[k], centres[k + random.below(n - k)]);
  centres.resize(clusters);

  std::vector<Index> cluster(n);
  const Mat3 inverse_cell = inverse(state.cell.h);
  for (std::size_t i = 0; i < n; ++i) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < clusters; ++k) {
      const Vec3 to = nearest(state, inverse_cell, static_cast<Index>(i), centres[k]);
      if (const double distance = dot(to, to); distance < least) least = distance, cluster[i] = static_cast<Index>(k);
    }
  }
  return cluster;
}

}  // namespace

double overlap_of(const State& state, std::size_t contact) {
  const auto& list = state.contacts;
  const auto& g = state.grains;
  const Index i = list.i[contact], j = list.j[contact];
  const Vec3 branch = g.position[j].vec() + state.cell.shift(list.image_of(contact)) - g.position[i].vec();
  return g.radius(i) + g.radius(j) - norm(branch);
}

std::vector<std::size_t> pairs_to_bond(const State& state, const BondSpec& spec, std::uint64_t seed) {
  const auto& list = state.contacts;
  const auto cluster = spec.clusters > 0 ? clusters_of(state, spec.clusters, seed) : std::vector<Index>{};
  std::vector<std::size_t> pairs;
  for (std::size_t c = 0; c < list.size(); ++c) {
    if (list.is_padding(c) || list.is_bonded(c) || overlap_of(state, c) < -spec.gap) continue;
    if (cluster.empty() || cluster[list.i[c]] == cluster[list.j[c]]) pairs.push_back(c);
  }
  return pairs;
}

std::size_t intact_bonds(const State& state) {
  const auto& list = state.contacts;
  std::size_t bonds = 0;
  for (std::size_t c = 0; c < list.size(); ++c) bonds += !list.is_padding(c) && list.is_bonded(c);
  return bonds;
}

}  // namespace eg
