#pragma once
// Integrals over a finite interval whose integrand is smooth inside but may have roots at the ends.
#include <algorithm>
#include <cmath>
#include <numbers>

namespace eg {

/// Double exponential rule (Takahasi and Mori 1974). Every halving of the step squares the error, so the last of two
/// sums that agree to eight digits is good to round-off. Needs low ≤ high.
template <class F>
double integrate(double low, double high, const F& f) {
  constexpr double reach = 3.4;  // of t: what lies beyond weighs less than round-off
  constexpr double right_angle = std::numbers::pi / 2;
  const double half = 0.5 * (high - low);
  if (!(half > 0)) return 0;
  // places are measured from the nearer end, so that roots there keep their digits
  const auto pair = [&](double t) {
    const double s = right_angle * std::sinh(t), c = std::cosh(s);
    const double from_end = half * std::exp(-s) / c, weight = right_angle * std::cosh(t) / (c * c);
    return weight * (f(low + from_end) + f(high - from_end));
  };
  double step = 0.5, sum = right_angle * f(low + half);
  for (double t = step; t <= reach; t += step) sum += pair(t);
  for (double value = step * sum;;) {
    step /= 2;
    for (double t = step; t <= reach; t += 2 * step) sum += pair(t);
    const double finer = step * sum, moved = std::abs(finer - value);
    if (moved <= 1e-8 * std::abs(finer) || step < 0.004) return half * finer;
    value = finer;
  }
}

}  // namespace eg
