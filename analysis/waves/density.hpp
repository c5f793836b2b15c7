#pragma once
// Density of states: how many modes there are in each interval of frequency. From the whole spectrum for small
// packings, by the kernel polynomial method for large ones (Silver and Röder 1994; Weisse, Wellein, Alvermann and
// Fehske 2006): moments of Chebyshev polynomials of A = M^−½KM^−½, estimated with random vectors and damped by
// Jackson's kernel.
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "waves/modes.hpp"

namespace eg {

struct Density {
  std::vector<double> edge;   ///< bounds of the intervals [Hz], equal steps from 0 to just above the highest mode
  std::vector<double> modes;  ///< in each interval; zero motions are in the first
  double total = 0;           ///< Σ modes: all degrees of freedom that can move
  double highest = 0;         ///< frequency of the fastest mode [Hz]
  double error = 0;  ///< standard error of the number of modes below a frequency, the largest one, over total; dense: 0
  int vectors = 0, moments = 0;  ///< kernel polynomial only
  std::string method;
};

/// From all_modes().
Density dense_density(const ModeSet& all, int bins);

struct KernelOptions {
  int moments = 0;  ///< 0: as many as resolve a fortieth of an interval
  int vectors = 0;  ///< 0: enough for an error of some 0.1 %
  std::uint64_t seed = 1;
  std::function<void(double)> progress = {};  ///< called with the share done
};

/// From moments · vectors/2 products K·x; five vectors of memory. The number of modes is exact, not estimated.
Density kernel_density(const Network& network, int bins, const KernelOptions& options = {});

}  // namespace eg
