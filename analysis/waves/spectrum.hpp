#pragma once
// Fourier transforms of traces (FFTW; Frigo and Johnson 2005): U(f) = Σ u exp(−2πi f t) interval.
#include <complex>
#include <span>
#include <vector>

namespace eg {

/// Spectrum at the frequencies k · step, k = 0 … size − 1.
struct Spectrum {
  double step = 0;                          ///< [Hz]
  std::vector<std::complex<double>> value;  ///< [m s]
  std::complex<double> at(double f) const;  ///< between two of them linearly
};

/// Of a trace whose last tenth fades out (cosine), padded with zeros to at least `pad` times its length.
Spectrum spectrum(std::span<const double> u, double interval, int pad = 4);

/// |U| of waves exp(i(kx − ωt)) travelling to larger x, over wave number and frequency.
struct WaveMap {
  double k_step = 0, f_step = 0;  ///< [rad/m], [Hz]
  std::size_t columns = 0;        ///< wave numbers 0 … (columns − 1) k_step, up to π/spacing
  std::size_t rows = 0;           ///< frequencies 0 … (rows − 1) f_step
  std::vector<double> value;      ///< row after row, the largest of each row is 1; rows without signal are 0
};

/// Of traces at equal `spacing` [m]; frequencies up to `highest` [Hz]. Rows whose amplitude is below 1e-3 of the
/// largest are left empty.
WaveMap wave_map(const std::vector<std::span<const double>>& traces, double interval, double spacing, double highest);

}  // namespace eg
