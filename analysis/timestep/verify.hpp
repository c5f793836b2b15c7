#pragma once
// The stability limit found by stepping: leapfrog of M ü = −K u from a random perturbation, contacts held.
#include "assembly/network.hpp"
#include "timestep/bracket.hpp"

namespace eg {

/// Brackets the largest stable step by bisection. A step counts as unstable when the amplitude passes what no stable
/// step can reach, 2k + 1 times the start after k steps; that is a proof but for round-off. It counts as stable when
/// this has not happened after as many steps as a mode beyond the limit by a quarter of the tolerance would need, even
/// if the perturbation held only 1e-5 of it. Throws std::invalid_argument unless guess > 0 and something can vibrate.
StabilityBracket verify_by_stepping(const Network& network, const BracketOptions& options);

}  // namespace eg
