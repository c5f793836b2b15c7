#pragma once
// One branch of the dispersion along an axis: the slowest wave that moves layers in a given direction.
#include <vector>

#include "assembly/network.hpp"

namespace eg {

struct Branch {
  std::vector<double> k, frequency;  ///< [rad/m], [Hz]

  double highest() const;  ///< [Hz]
  /// Wave number, phase speed ω/k and group speed dω/dk at a frequency below the first maximum of the branch; NaN
  /// above.
  double wave_number(double f) const;
  double phase_speed(double f) const;
  double group_speed(double f) const;
};

/// k from 0 to `last` [rad/m] along `axis`, motion along `motion` (0, 1, 2), `points` + 1 of them. Begins with the
/// wave that moves the layers so most and follows it; where no wave moves them so any more, the branch ends.
Branch acoustic_branch(const Network& unit, int axis, int motion, double last, int points = 400);

}  // namespace eg
