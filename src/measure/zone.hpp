#pragma once
// Volumes common to a grain and a zone of the laboratory: slabs, boxes, cylinders, shells, wedges, whole or cut [m³].
// In 2D a zone has no extent along z, grains are disks and volumes are areas [m²].
#include <numbers>

#include "base/vec.hpp"
#include "measure/section.hpp"

namespace eg {

/// Slabs and boxes: what is not given reaches to infinity [m].
struct BoxZone {
  Extent x, y, z;
};

/// A part of a cylinder around the z axis.
struct CylinderZone {
  Extent height;                          ///< z [m]
  Extent radius{0, Extent{}.high};        ///< distance from the axis [m], low ≥ 0
  Extent angle{0, 2 * std::numbers::pi};  ///< from x towards y [rad], at most a full turn
};

double volume_of(const BoxZone&, int dimension);
double volume_of(const CylinderZone&, int dimension);

/// Whether a point belongs to the zone; lower bounds belong to it, upper ones do not.
bool holds(const BoxZone&, int dimension, const Vec3& point);
bool holds(const CylinderZone&, int dimension, const Vec3& point);

/// Volume of a sphere (2D: area of a disk) that lies in the zone, to 1e-12 of the grain's volume. Slabs are exact
/// (caps); else areas of cross-sections in closed form are integrated along z between the places where edges touch.
double volume_inside(const BoxZone&, int dimension, const Vec3& centre, double radius);
double volume_inside(const CylinderZone&, int dimension, const Vec3& centre, double radius);

}  // namespace eg
