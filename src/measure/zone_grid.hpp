#pragma once
// Void ratios in the zones of a container: rings, sectors and layers of a cylinder, cells of a box.
#include <array>
#include <cstddef>
#include <vector>

#include "measure/zone.hpp"
#include "state/state.hpp"

namespace eg {

/// A box or a cylinder that is cut into zones along three coordinates: x, y, z of a box; radius, angle and height of a
/// cylinder, whose height is along `axis` and whose angle runs from the next axis in the order x, y, z, x, y.
struct ZoneGrid {
  enum class Shape { box, cylinder };
  Shape shape = Shape::box;
  int axis = 2;                                ///< of a cylinder; 2D: 2
  Vec3 centre{};                               ///< a point of the cylinder's axis [m]; not read for a box
  std::array<std::vector<double>, 3> edges{};  ///< ascending, at least two each [m], [rad]; 2D: of z they are not read

  std::size_t zones(int coordinate) const { return edges[static_cast<std::size_t>(coordinate)].size() - 1; }
};

/// What the walls and the cell leave to the grains, or where there are none, what the grains fill: {x, y, z} [m].
std::array<Extent, 3> specimen_extents(const State&);

/// The box or cylinder that holds the specimen, as one zone. A cylinder is that of the walls along its axis; without
/// such it stands in the middle of specimen_extents() and reaches to the outermost grain.
ZoneGrid whole_specimen(const State&, ZoneGrid::Shape, int axis);

struct ZoneMeasures {
  std::array<Extent, 3> bounds{};  ///< coordinates of the grid; z of 2D means nothing
  double volume = 0;               ///< [m³] (2D: m²)
  double solid = 0;                ///< of the parts of grains inside; what overlaps counts twice
  std::size_t grains = 0;          ///< with their centre inside

  double solid_fraction() const { return solid / volume; }
  double void_ratio() const { return (volume - solid) / solid; }  ///< infinite in an empty zone
};

struct ZoneTable {
  std::vector<ZoneMeasures> zones;  ///< first coordinate slowest, last fastest
  ZoneMeasures whole{};             ///< all zones together
  /// (1/m) Σ (e_i − e_whole)² over the m zones that hold grains. Bernhardt et al. (2016) print 1/(m − 1), but their
  /// table has 1/m.
  double variance = 0;
};

/// Periodic images are part of the packing. Volumes are those of measure/zone.hpp. InputError: more than 3e7 zones.
ZoneTable measure_zones(const State&, const ZoneGrid&);

}  // namespace eg
