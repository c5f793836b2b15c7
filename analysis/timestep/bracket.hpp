#pragma once
// The stability limit as an experiment finds it: step sizes are tried until the limit lies between two close ones.
#include <cstdint>
#include <functional>

namespace eg {

struct StabilityBracket {
  double stable = 0, unstable = 0;  ///< [s]: no growth seen at the first, growth at the second
  std::int64_t steps = 0;           ///< taken in all
  int trials = 0;                   ///< step sizes tried
};

struct BracketOptions {
  double guess = 0;                           ///< a step near the limit to start from [s], > 0
  double tolerance = 5e-4;                    ///< relative width of the bracket at the end
  std::uint64_t seed = 2;                     ///< of the perturbation that is stepped
  std::function<void(double)> progress = {};  ///< called with the share of the work done, 0…1
};

/// Widening steps from the guess, then bisection. `grows(dt, steps)` tries one step size and adds the steps it took.
StabilityBracket bracket_limit(const BracketOptions& options,
                               const std::function<bool(double dt, std::int64_t& steps)>& grows);

}  // namespace eg
