#pragma once
// Frequencies of Bloch waves along a path of wave vectors, and the speeds of long waves.
#include <functional>
#include <string>
#include <vector>

#include "waves/bloch.hpp"
#include "waves/zone.hpp"

namespace eg {

struct DispersionPoint {
  Vec3 k;                        ///< [rad/m]
  double distance = 0;           ///< along the path [rad/m]
  std::vector<BlochMode> modes;  ///< slowest first
};

struct Dispersion {
  std::vector<DispersionPoint> points;
  std::vector<std::size_t> corners;  ///< which of them are the named points of the path
};

/// `steps` intervals between each two of the points; `edges` as for wave_vector(). `progress` gets the share done.
Dispersion dispersion(const Network& unit, const Mat3& edges, const std::vector<ZonePoint>& path, int steps,
                      const std::function<void(double)>& progress = {});

/// Speeds ω/|k| as k → 0 along a direction (any length) [m/s], slowest first: three, in 2D two. The acoustic waves are
/// those that move the cell as a whole; `edge` is a length of the cell [m]. Error about 1e-8 (two wave vectors,
/// extrapolated).
std::vector<double> long_wave_speeds(const Network& unit, const Vec3& direction, double edge);

}  // namespace eg
