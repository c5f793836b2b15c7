#include "eigen/general_spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace eg {

GeneralSpectrum classify(std::span<const std::complex<double>> values, double zero) {
  GeneralSpectrum g;
  for (const auto& mu : values) g.radius = std::max(g.radius, std::abs(mu));
  const double small = zero * g.radius;
  for (const auto& mu : values) {
    if (std::abs(mu.imag()) <= small) {
      g.largest_real = std::max(g.largest_real, mu.real());
      if (mu.real() >= -small) continue;
      ++g.collapse;
      g.collapse_rate = std::max(g.collapse_rate, std::sqrt(-mu.real()));
    } else if (mu.imag() > 0) {  // its conjugate is the other half of the pair
      ++g.flutter;
      const std::complex<double> s = std::sqrt(-mu);  // Re s ≥ 0: the half that grows
      if (s.real() <= g.flutter_rate) continue;
      g.flutter_rate = s.real();
      g.flutter_frequency = std::abs(s.imag()) / (2 * std::numbers::pi);
    }
  }
  return g;
}

}  // namespace eg
