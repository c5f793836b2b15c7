#pragma once
// Force chains: grains under high stress that hand it on to each other along its direction.
#include <span>
#include <vector>

#include "state/gather.hpp"

namespace eg {

struct ForceChains {
  static constexpr int none = -1;
  std::vector<int> chain;   ///< number of the chain of every grain, from 0, the longest first; `none`
  std::vector<int> link;    ///< number of the chain that a contact holds together, in their order; `none`
  std::vector<int> length;  ///< grains of every chain
  double grain_share = 0;   ///< grains in chains over all grains [-]
  double mean_length = 0;   ///< grains a chain
};

/// After Peters et al. (2005): a grain is highly stressed when the major principal value of its stress is above the
/// mean over all grains that touch others; two of them that touch belong together when the branch lies within
/// `angle` [rad] of the major principal direction of both; three or more so joined are a chain. Branches of a chain are
/// not cut apart.
ForceChains force_chains(const State&, std::span<const ContactPoint>, double angle = 0.7853981633974483);

}  // namespace eg
