#pragma once
// The stability limit found by stepping: leapfrog of M ü = −K u from a random perturbation, contacts held.
#include <cstdint>
#include <functional>

#include "assembly/network.hpp"

namespace eg {

struct VerifyOptions {
  double guess = 0;         ///< a step near the limit to start from [s], e.g. the middle of the interval
  double tolerance = 5e-4;  ///< relative width of the bracket at the end
  std::uint64_t seed = 2;   ///< of the perturbation
  std::function<void(double)> progress = {};  ///< called with the share of the work done, 0…1
};

struct StabilityBracket {
  double stable = 0, unstable = 0;  ///< [s]: no growth seen at the first, growth at the second
  std::int64_t steps = 0;           ///< taken in all
  int trials = 0;                   ///< steps sizes tried
};

/// Brackets the largest stable step by bisection. A run is unstable once the amplitude exceeds what a bounded leapfrog
/// motion can reach: near the limit that is 1/√(1 − (ωΔt/2)²) times the start, here at most 1/√(tolerance/2); a run is
/// long enough that a mode beyond the limit by the tolerance must have passed that mark, even if the perturbation held
/// only 1e-8 of it. Throws std::invalid_argument unless guess > 0 and the network has a spring on a movable grain.
StabilityBracket verify_by_stepping(const Network& network, const VerifyOptions& options);

}  // namespace eg
