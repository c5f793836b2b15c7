#pragma once
// What `eigengrain waves transmit` has to say, as text, JSON, tables and figures.
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "report/plot.hpp"
#include "waves/arrival.hpp"
#include "waves/branch.hpp"

namespace eg {

struct TransmitReport {
  std::string name, title;
  std::size_t particles = 0;
  TransmitSetup setup;
  Transmission test;
  std::optional<Branch> branch;  ///< of a lattice
  double amplitude_share = 0;    ///< of the source, over the mean overlap
  double speed = 0,
         wavelength = 0;          ///< that the test was planned with: dispersion, else the affine stiffness [m/s], [m]
  std::size_t near = 0, far = 0;  ///< traces between which the wave is timed
  std::vector<Arrival> arrivals, from_source;
  double phase_speed = 0;                     ///< at the frequency of the signal [m/s]
  std::vector<double> frequencies, response;  ///< [Hz], [-]: a layer near the source over the source
  double cutoff = 0;                          ///< [Hz], NaN when the signal does not reach it
  std::optional<WaveMap> map;
  std::vector<double> ridge;  ///< [rad/m], a row of the map each
  std::vector<std::string> warnings;
  double elapsed = 0, memory = 0;  ///< [s], [bytes]

  /// Largest and mean distance of the ridge from the branch over k, at the frequencies whose waves have passed half of
  /// the layers and where k is at least four of the wave numbers that the length of the test tells apart.
  struct Ridge {
    double mean = 0, worst = 0;
    int rows = 0;
  };
  std::optional<Ridge> ridge_error() const;
};

std::string text_of(const TransmitReport& report);
nlohmann::json json_of(const TransmitReport& report);
void write_tables(const TransmitReport& report, const std::string& path);
Figure map_figure(const TransmitReport& report);
Figure trace_figure(const TransmitReport& report);

}  // namespace eg
