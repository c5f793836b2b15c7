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

namespace {

/// The branch goes on where a wave of that motion lies nearest to its straight continuation `expected` [Hz].
double nearest(const std::vector<BlochMode>& modes, std::size_t motion, double expected) {
  double best = std::numeric_limits<double>::infinity();
  for (const BlochMode& m : modes)
    if (m.mean[motion] > 1e-9 && std::abs(m.frequency() - expected) < std::abs(best - expected)) best = m.frequency();
  return best;
}

}  // namespace

Branch acoustic_branch(const Network& unit, int axis, int motion, double last, int points) {
  const auto along = static_cast<std::size_t>(motion);
  Branch branch{{0.0}, {0.0}};
  for (int n = 1; n <= points; ++n) {
    Vec3 k;
    k[axis] = last * n / points;
    const auto modes = bloch_modes(unit, k);
    const auto& f = branch.frequency;
    const auto start = std::ranges::max_element(modes, {}, [&](const BlochMode& m) { return m.mean[along]; });
    const double next = n == 1 ? start->frequency() : nearest(modes, along, 2 * f.back() - f[f.size() - 2]);
    if (!std::isfinite(next) || (n > 1 && std::abs(next - f.back()) > 3 * f[1])) break;
    branch.k.push_back(k[axis]), branch.frequency.push_back(next);
  }
  return branch;
}

}  // namespace eg
