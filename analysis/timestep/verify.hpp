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
  int trials = 0;                   ///< step sizes tried
};

/// Brackets the largest stable step by bisection. A step counts as unstable when the amplitude passes what no stable
/// step can reach, 2k + 1 times the start after k steps; that is a proof but for round-off. It counts as stable when
/// this has not happened after as many steps as a mode beyond the limit by a quarter of the tolerance would need, even
/// if the perturbation held only 1e-5 of it. Throws std::invalid_argument unless guess > 0 and something can vibrate.
StabilityBracket verify_by_stepping(const Network& network, const VerifyOptions& options);

}  // namespace eg
