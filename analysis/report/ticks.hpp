#pragma once
// Where an axis carries ticks, and what they say.
#include <string>
#include <vector>

namespace eg {

struct Tick {
  double value = 0;
  std::string label;  ///< empty: a minor tick
};

struct Ticks {
  std::vector<Tick> ticks;  ///< ascending, all within [low, high]
  int exponent = 0;         ///< labels are to be read times 10^exponent
};

/// Steps of 1, 2 or 5 times a power of ten, about `wanted` of them. Needs low < high.
Ticks linear_ticks(double low, double high, int wanted = 6);

/// Decades with their 2 … 9 as minor ticks; over a short range 2 and 5 are labelled too, over a very short one the
/// ticks are linear. Needs 0 < low < high.
Ticks log_ticks(double low, double high);

/// "10⁻³"
std::string power_of_ten(int exponent);

}  // namespace eg
