#pragma once
// Areas common to a disk and the cross-sections of zones, in closed form. Lengths [m], areas [m²], angles [rad].
#include "measure/extent.hpp"

namespace eg {

/// Disk around the origin and the rectangle x × y.
double disk_in_rectangle(double radius, const Extent& x, const Extent& y);

/// Disk at `distance` ≥ 0 from the centre of a ring; 0 ≤ ring.low.
double disk_in_ring(double radius, double distance, const Extent& ring);

/// Disk with its centre at polar coordinates (distance, azimuth) from the centre of a ring, of which only the sector
/// counts; sector.length() ≤ 2π. Accurate to round-off of distance × radius.
double disk_in_sector(double radius, double distance, double azimuth, const Extent& ring, const Extent& sector);

}  // namespace eg
