#include "report/scale.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace eg {

double Scale::operator()(double value) const {
  const double share = logarithmic ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
  return start + share * (end - start);
}

Scale scale_for(const Axis& axis, const std::vector<double>& values) {
  Scale scale{.logarithmic = axis.logarithmic};
  if (!axis.rows.empty()) {
    scale.low = -0.7, scale.high = static_cast<double>(axis.rows.size()) - 0.3;
    return scale;
  }
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double v : values)
    if (std::isfinite(v) && (v > 0 || !axis.logarithmic)) low = std::min(low, v), high = std::max(high, v);
  if (low > high) low = axis.logarithmic ? 1 : 0, high = axis.logarithmic ? 10 : 1;  // nothing to show
  if (axis.logarithmic) {
    const double room = std::max(std::pow(high / low, 0.05), 1.1);
    scale.low = low / room, scale.high = high * room;
  } else {
    const double pad = high > low ? 0 : low != 0 ? 0.1 * std::abs(low) : 1;
    const auto ticks = linear_ticks(low - pad, high + pad).ticks;
    const double step = ticks[1].value - ticks[0].value;
    scale.low = step * std::floor((low - pad) / step + 1e-9), scale.high = step * std::ceil((high + pad) / step - 1e-9);
  }
  if (std::isfinite(axis.low)) scale.low = axis.low;
  if (std::isfinite(axis.high)) scale.high = axis.high;
  return scale;
}

Ticks ticks_for(const Axis& axis, const Scale& scale) {
  if (!axis.marks.empty()) {
    Ticks named;
    for (const auto& [value, name] : axis.marks)
      if (scale.shows(value)) named.ticks.push_back({value, name});
    return named;
  }
  if (axis.rows.empty())
    return axis.logarithmic ? log_ticks(scale.low, scale.high) : linear_ticks(scale.low, scale.high);
  Ticks result;
  for (const auto& name : axis.rows) result.ticks.push_back({static_cast<double>(result.ticks.size()), name});
  return result;
}

}  // namespace eg
