#pragma once
// What the eigenvalues μ of a nonsymmetric M⁻¹K mean for ü = −M⁻¹K u, where a motion goes as e^{st} with s² = −μ.
#include <complex>
#include <cstddef>
#include <span>

namespace eg {

struct GeneralSpectrum {
  double radius = 0;             ///< largest |μ| [1/s²]
  double largest_real = 0;       ///< largest real μ [1/s²]
  std::size_t flutter = 0;       ///< complex pairs: oscillations that grow by themselves
  double flutter_rate = 0;       ///< fastest growth among them, Re s [1/s] …
  double flutter_frequency = 0;  ///< … and its frequency, Im s/2π [Hz]
  std::size_t collapse = 0;      ///< negative real μ: motion away without oscillation
  double collapse_rate = 0;      ///< fastest growth among them, √−μ [1/s]
};

/// Sorts eigenvalues; what is smaller than `zero` times the largest |μ| counts as zero, in the imaginary part too.
GeneralSpectrum classify(std::span<const std::complex<double>> values, double zero = 1e-7);

}  // namespace eg
