#pragma once
#include <limits>

namespace eg {

/// low ≤ value < high; what is not given reaches to infinity.
struct Extent {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();

  double length() const { return high - low; }
  bool holds(double value) const { return value >= low && value < high; }
};

}  // namespace eg
