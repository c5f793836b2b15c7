#pragma once
// From the values of an axis to places on the page.
#include <vector>

#include "report/plot.hpp"
#include "report/ticks.hpp"

namespace eg {

struct Scale {
  double low = 0, high = 1;  ///< values at the ends of the axis
  bool logarithmic = false;
  double start = 0, end = 1;  ///< places of low and high [pt]

  /// Place of a value [pt]; not finite when the value has none (≤ 0 on a logarithmic axis).
  double operator()(double value) const;
  bool shows(double value) const { return value >= low && value <= high; }
};

/// The range of an axis that shows `values` (those that are finite, and positive if logarithmic): whole ticks on a
/// linear axis, some room on a logarithmic one, half a row beside the first and last of rows. Given ends are kept.
Scale scale_for(const Axis& axis, const std::vector<double>& values);

/// Ticks of the axis over its scale; rows are ticks at 0, 1, 2 …
Ticks ticks_for(const Axis& axis, const Scale& scale);

}  // namespace eg
