#pragma once
// Part of a network: some grains, cut loose from the rest.
#include <span>
#include <vector>

#include "timestep/matrix_weights.hpp"

namespace eg {

/// The grains given and those within `shells` contacts of them, in that order, each once.
std::vector<Index> grow_patch(const Sides& sides, std::vector<Index> grains, int shells);

/// The grains that splitting does not prove to be below sigma, with `shells` shells of neighbours, stiffest first.
std::vector<Index> stiff_patch(const Sides& sides, const BlockRanges& ranges, double sigma, int shells);

/// Neighbours that are taken into a patch: `count` shells, of grains with λmax(S_i) ≥ least × σ only.
struct Shells {
  int count = 1;
  double least = 0;
};

/// The same, fewer: a grain that its range leaves in doubt is settled by its block.
std::vector<Index> stiff_patch(const WeightedContacts& contacts, const BlockRanges& ranges, double sigma,
                               const Shells& shells);

/// The network of these grains alone, in this order, with every other grain held fixed (its contacts become walls). Its
/// matrix is a principal part of the whole one, so λmax of the patch ≤ λmax (Cauchy's interlacing).
Network patch_network(const Sides& sides, std::span<const Index> grains);

/// Place of every grain of the network in the patch, or no_index.
std::vector<Index> places(const Sides& sides, std::span<const Index> grains);

}  // namespace eg
