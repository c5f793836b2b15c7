#pragma once
// How values spread over contacts, grains and directions.
#include <cstddef>
#include <span>
#include <vector>

#include "state/gather.hpp"

namespace eg {

/// Equal bins from `low`; values outside are counted apart.
struct Histogram {
  double low = 0, width = 0;
  std::vector<std::size_t> count;
  std::size_t below = 0, above = 0;

  double middle(std::size_t bin) const { return low + (static_cast<double>(bin) + 0.5) * width; }
  std::size_t total() const;
  /// Probability density of a bin: count/(total · width); 0 without values.
  double density(std::size_t bin) const;
};
Histogram histogram(std::span<const double> values, double low, double high, std::size_t bins);

/// Grains by their number of contacts: count[c] grains have c contacts (connectivity of Shire and O'Sullivan 2013).
std::vector<std::size_t> connectivity(std::size_t grains, std::span<const ContactPoint>);

/// N/⟨N⟩ over contacts: bins of 0.1 up to 8.
Histogram normal_forces(std::span<const ContactPoint>);

/// Angular velocities of the grains that turn [rad/s]; 2D: about z.
struct Spins {
  Vec3 mean;
  double deviation = 0;  ///< root mean square of |ω − mean|
  double largest = 0;    ///< |ω|
  /// One component of ω − mean over its own standard deviation, all axes that turn counted alike (2D: z): bins of 0.2
  /// from −5 to 5. A normal distribution would be exp(−x²/2)/√(2π).
  Histogram scaled;
  double kurtosis = 0;  ///< of the same; 3 for a normal distribution
};
Spins spins(const State&);

}  // namespace eg
