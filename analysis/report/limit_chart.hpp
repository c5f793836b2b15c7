#pragma once
// Where each rule of thumb stands against the exact limit.
#include <string>
#include <vector>

#include "report/plot.hpp"

namespace eg {

struct LimitRow {
  std::string name{};
  double ratio = 0;  ///< of the estimated step to the limit: > 1 is unstable
};

/// One bar a row on a logarithmic axis, from the limit (1) to the ratio, greatest ratio on top. Right of 1 the plane is
/// shaded as unstable. `proved` is the ratio of the step that is proved stable to the limit: the interval [proved, 1]
/// is drawn as a band, too narrow to be seen (and so without a key) when it is below 1 %. Rows whose ratio is not
/// positive and finite are left out.
Figure limit_chart(std::vector<LimitRow> rows, double proved = 1);

}  // namespace eg
