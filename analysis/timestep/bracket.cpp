#include "timestep/bracket.hpp"

#include <cmath>
#include <stdexcept>

namespace eg {

StabilityBracket bracket_limit(const BracketOptions& options,
                               const std::function<bool(double dt, std::int64_t& steps)>& grows) {
  if (!(options.guess > 0)) throw std::invalid_argument("bracket_limit: guess must be positive");
  StabilityBracket bracket;
  const auto unstable = [&](double dt) {
    ++bracket.trials;
    return grows(dt, bracket.steps);
  };
  double factor = 1.02;
  if (unstable(options.guess)) {
    bracket.unstable = options.guess;
    for (bracket.stable = options.guess / factor; unstable(bracket.stable); bracket.stable /= factor *= factor)
      bracket.unstable = bracket.stable;
  } else {
    bracket.stable = options.guess;
    for (bracket.unstable = options.guess * factor; !unstable(bracket.unstable); bracket.unstable *= factor *= factor)
      bracket.stable = bracket.unstable;
  }
  const double first = std::log(bracket.unstable / bracket.stable), last = std::log1p(options.tolerance);
  while (bracket.unstable > bracket.stable * (1 + options.tolerance)) {
    const double middle = 0.5 * (bracket.stable + bracket.unstable);
    (unstable(middle) ? bracket.unstable : bracket.stable) = middle;
    if (options.progress)
      options.progress(std::log(first / std::log(bracket.unstable / bracket.stable)) / std::log(first / last));
  }
  return bracket;
}

}  // namespace eg
