#include "timestep/patch.hpp"

#include <algorithm>
#include <utility>

namespace eg {
namespace {

template <class Wanted>
std::vector<Index> grow(const Sides& sides, std::vector<Index> grains, int shells, Wanted wanted) {
  std::vector<char> taken(sides.size(), 0);
  for (const Index g : grains) taken[g] = 1;
  std::size_t begin = 0;
  for (int shell = 0; shell < shells; ++shell) {
    const std::size_t end = grains.size();
    for (std::size_t k = begin; k < end; ++k)
      for (const Side& side : sides.of(grains[k])) {
        if (side.role == Side::Role::alone) continue;
        const Spring& s = sides.network().springs[side.spring];
        const Index other = side.role == Side::Role::first ? s.j : s.i;
        if (wanted(other) && !std::exchange(taken[other], 1)) grains.push_back(other);
      }
    begin = end;
  }
  return grains;
}

template <class Below>
std::vector<Index> patch_of_others(const Sides& sides, const BlockRanges& ranges, int shells, double least,
                                   Below below) {
  std::vector<Index> grains;
  for (std::size_t g = 0; g < sides.size(); ++g)
    if (!sides.of(g).empty() && !below(g)) grains.push_back(static_cast<Index>(g));
  grains = grow(sides, std::move(grains), shells, [&](Index g) { return ranges.low[g] >= least; });
  std::sort(grains.begin(), grains.end(),
            [&](Index a, Index b) { return ranges.low[a] != ranges.low[b] ? ranges.low[a] > ranges.low[b] : a < b; });
  return grains;
}

}  // namespace

std::vector<Index> grow_patch(const Sides& sides, std::vector<Index> grains, int shells) {
  return grow(sides, std::move(grains), shells, [](Index) { return true; });
}

std::vector<Index> stiff_patch(const Sides& sides, const BlockRanges& ranges, double sigma, int shells) {
  return patch_of_others(sides, ranges, shells, 0, [&](std::size_t g) { return ranges.high[g] < sigma; });
}

std::vector<Index> stiff_patch(const WeightedContacts& contacts, const BlockRanges& ranges, double sigma,
                               const Shells& shells) {
  const Sides& sides = contacts.sides();
  return patch_of_others(sides, ranges, shells.count, shells.least * sigma, [&](std::size_t g) {
    return ranges.high[g] < sigma ||
           (ranges.low[g] < sigma && block_is_below(contacts.block(g), sides.of(g).size(), sigma));
  });
}

std::vector<Index> places(const Sides& sides, std::span<const Index> grains) {
  std::vector<Index> place(sides.size(), no_index);
  for (std::size_t k = 0; k < grains.size(); ++k) place[grains[k]] = static_cast<Index>(k);
  return place;
}

Network patch_network(const Sides& sides, std::span<const Index> grains) {
  const Network& whole = sides.network();
  const auto place = places(sides, grains);
  Network part;
  part.dimension = whole.dimension;
  part.rotation = whole.rotation;
  for (const Index g : grains) {
    part.inverse_mass.push_back(whole.inverse_mass[g]);
    if (whole.rotation) part.inverse_inertia.push_back(whole.inverse_inertia[g]);
    part.radius.push_back(whole.radius[g]);
    part.id.push_back(g);
  }
  for (const Index g : grains)
    for (const Side& side : sides.of(g)) {
      Spring s = whole.springs[side.spring];
      const bool first = s.i == g;
      const Index other = first ? s.j : s.i;
      const Index there = other == no_index ? no_index : place[other];
      if (there == no_index) {  // held: a wall; seen from j the normal turns round
        if (!first) s.arm_i = s.arm_j, s.n = -s.n;
        s.i = place[g], s.j = no_index, s.arm_j = 0;
        part.springs.push_back(s);
      } else if (first) {
        s.i = place[g], s.j = there;
        part.springs.push_back(s);
      }
    }
  return part;
}

}  // namespace eg
