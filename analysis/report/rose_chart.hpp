#pragma once
// Rose diagrams: a value for every direction, flat (2D) or as a solid body (3D).
#include <filesystem>
#include <string>
#include <vector>

namespace eg {

struct RosePetal {
  double azimuth_from = 0, azimuth_to = 0;  ///< from x towards y [rad]
  double height_from = 0, height_to = 0;    ///< z on the unit sphere; flat: both 0
  double value = 0;                         ///< ≥ 0: length of the petal
};

struct RoseChart {
  std::string title{}, subtitle{};
  std::string value{};  ///< what the length of a petal means
  bool solid = false;   ///< petals are patches of a sphere, seen from x = y, a little above
  std::vector<RosePetal> petals{};
};

/// Flat: sectors around a circle of value 1. Solid: a spike a petal, shaded by its value, and the axes x, y, z. The
/// ending of `path` (.svg, .png, .pdf) is the format. Throws InputError when that is unknown or the file cannot be
/// written.
void write_rose(const RoseChart& chart, const std::filesystem::path& path);

}  // namespace eg
