#pragma once
// Eigenvalues at one end of the spectrum of a general real operator, by ARPACK's implicitly restarted Arnoldi method
// (Sorensen 1992; Lehoucq, Sorensen and Yang 1998).
#include <complex>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace eg {

enum class SpectrumEnd { largest_magnitude, largest_imaginary, smallest_real };

struct GeneralArpackOptions {
  int wanted = 8;
  int basis = 40;           ///< Arnoldi vectors kept, above wanted + 2
  double tolerance = 1e-9;  ///< relative, of the Ritz values
  int max_restarts = 500;
  std::uint64_t seed = 1;
};

/// Those that converged, complex ones with their conjugates; maybe none. `apply(x, y)`: y = A x. rows > wanted + 2.
std::vector<std::complex<double>> arpack_general(
    std::size_t rows, const std::function<void(std::span<const double>, std::span<double>)>& apply, SpectrumEnd end,
    const GeneralArpackOptions& options = {});

}  // namespace eg
