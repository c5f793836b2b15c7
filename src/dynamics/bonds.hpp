#pragma once
// Which contacts become bonds, and how many there are.
#include <cstdint>
#include <vector>

#include "state/scene.hpp"
#include "state/state.hpp"

namespace eg {

/// δ of a listed contact of two grains [m], < 0 for a gap.
double overlap_of(const State&, std::size_t contact);

/// Listed contacts without a bond whose gap is below spec.gap; with spec.clusters > 0 only those within one cluster.
/// Clusters grow around so many grains, drawn at random: a grain belongs to the nearest of them.
std::vector<std::size_t> pairs_to_bond(const State&, const BondSpec& spec, std::uint64_t seed);

/// Bonds that hold.
std::size_t intact_bonds(const State&);

}  // namespace eg
