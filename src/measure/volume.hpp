#pragma once
// Volumes of grains, of their overlaps and of the voids between them [m³]; 2D: areas [m²].
#include <span>

#include "measure/extent.hpp"
#include "state/gather.hpp"

namespace eg {

double grain_volume(int dimension, double radius);

/// Volume common to two spheres (2D: area common to two disks) whose centres are `distance` ≥ 0 apart.
double lens_volume(int dimension, double ri, double rj, double distance);

/// Part of a sphere beyond a plane at `height` from its centre, −radius ≤ height ≤ radius (2D: of a disk).
double cap_volume(int dimension, double radius, double height);

/// What walls across axis k leave free [m], the two nearest to each other of those that stand face to face, where they
/// have moved to: the halves of a shear box stay as wide as they were. Infinite where there is none.
Extent wall_gap(const State&, int k);

/// Section across `axis` (unit) of what hollow cylinders along it leave of the solid ones within them, in the angle
/// that grains press on [m²]; the widest of each count. 0 without a hollow one.
double round_section(const State&, const Vec3& axis);

/// Volume of the specimen: of the cell; between parallel walls across x, y or z, the innermost ones count, wherever
/// they have moved; round_section() times height; of the inside of a membrane as it was last laid.
double specimen_volume(const State&);

/// Sum of the grains' own volumes: what overlaps counts twice. Of grains on a membrane, which runs through their
/// centres, the part inside it.
double solid_volume(const State&);

/// What contacts make overlap: lenses between grains and caps beyond walls, contact by contact. Where three grains
/// overlap at one place the common part is counted more than once; contacts of real packings are too small for that.
double overlap_volume(const State&, std::span<const ContactPoint>);

/// e = (V − V_s)/V_s. DEM papers use V_s = solid_volume(); solid_volume() − overlap_volume() corrects for overlaps.
inline double void_ratio(double volume, double solid) { return (volume - solid) / solid; }

struct SizeStatistics {
  double smallest = 0, largest = 0;  ///< diameters [m]
  double mean = 0;                   ///< diameter, by number [m]
  double deviation = 0;              ///< standard deviation of the diameter [m]
  double d50 = 0;                    ///< diameter at which half the mass passes, for grains of one density [m]
};
SizeStatistics size_statistics(const State&);

}  // namespace eg
