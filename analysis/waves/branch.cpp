#include "waves/branch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "waves/bloch.hpp"

namespace eg {

double Branch::highest() const { return frequency.empty() ? 0 : *std::ranges::max_element(frequency); }

double Branch::wave_number(double f) const {
  for (std::size_t n = 1; n < k.size() && frequency[n] > frequency[n - 1]; ++n)
    if (frequency[n - 1] <= f && f <= frequency[n])
      return k[n - 1] + (k[n] - k[n - 1]) * (f - frequency[n - 1]) / (frequency[n] - frequency[n - 1]);
  return std::numeric_limits<double>::quiet_NaN();
}

double Branch::phase_speed(double f) const { return 2 * std::numbers::pi * f / wave_number(f); }

double Branch::group_speed(double f) const {
  const double step = 0.01 * f;
  return 4 * std::numbers::pi * step / (wave_number(f + step) - wave_number(f - step));
}

Branch acoustic_branch(const Network& unit, int axis, int motion, double last, int points) {
  Branch branch;
  for (int n = 0; n <= points; ++n) {
    Vec3 k;
    k[axis] = last * n / points;
    const auto modes = bloch_modes(unit, k);
    const auto found = std::ranges::find_if(
        modes, [&](const BlochMode& m) { return m.mean[static_cast<std::size_t>(motion)] > 1e-3; });
    if (found == modes.end()) break;
    branch.k.push_back(k[axis]), branch.frequency.push_back(found->frequency());
  }
  return branch;
}

}  // namespace eg
