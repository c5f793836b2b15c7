#pragma once
// Travel times between two traces, as wave tests in the laboratory are read (Yamashita et al. 2009 compare the ways),
// and what the spectra of all traces say: wave speed at a frequency, response, cut-off.
#include <span>
#include <string>
#include <vector>

#include "waves/spectrum.hpp"
#include "waves/transmit.hpp"

namespace eg {

struct Arrival {
  std::string method;  ///< "start-start", "peak-peak", "cross-correlation", "phase slope"
  double time = 0;     ///< [s]; NaN where the traces do not tell
  double speed = 0;    ///< [m/s]
};

/// From trace `from` to trace `to`. Start: 5 % of the trace's largest displacement is passed. Peak: first maximum of 60
/// % or more. Phase slope: −dφ/dω of the cross-spectrum around `frequency` (± 25 %), a group delay.
std::vector<Arrival> arrivals(const Transmission& test, std::size_t from, std::size_t to, double frequency);

/// Phase speed ω/k at a frequency [m/s]: k is the slope of the phase over distance, traces `from` … `to`.
double phase_speed(const Transmission& test, std::size_t from, std::size_t to, double frequency);

/// |U(to)|/|U(from)| at the frequencies given; NaN where the source holds less than 3 % of its largest amplitude.
std::vector<double> response(const Transmission& test, std::size_t from, std::size_t to,
                             std::span<const double> frequencies);

/// Lowest frequency [Hz] from which the response is below a half over a tenth of itself and more: waves die out there
/// (S waves of spheres go on above a gap, where grains turn as they move). NaN when the response does not fall so.
double cutoff(std::span<const double> frequencies, std::span<const double> response);

/// Ridge of a map: wave number of the largest amplitude at each frequency [rad/m], between the grid's by a parabola;
/// NaN where there is no signal.
std::vector<double> ridge(const WaveMap& map);

}  // namespace eg
