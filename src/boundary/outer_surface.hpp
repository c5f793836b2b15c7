#pragma once
// The surface of a specimen as seen from outside: what a probe touches that rolls around it.
#include <cstdint>
#include <vector>

#include "state/state.hpp"

namespace eg {

/// A triangle, in 2D an edge. Its corners are centres of grains, or their feet on the planes that close the surface.
struct SurfaceFacet {
  std::array<Vec3, 3> corner;         ///< seen from outside counter-clockwise; 2D: two, outside on the right [m]
  std::array<Index, 3> grain;         ///< whose centre or foot a corner is
  std::uint64_t planes = 0;           ///< bits of the planes that it lies on: covered by them
  Vec3 outward(int dimension) const;  ///< normal times area [m²] (2D: m)
};

struct OuterSurface {
  std::vector<SurfaceFacet> facets;
  double volume = 0;        ///< inside [m³] (2D: m²)
  double solid = 0;         ///< of it, grains: of one on the surface the part within the solid angle of its cells
  std::vector<Index> lost;  ///< grains outside
};

/// Of the Delaunay cells of all centres, and of the feet of grains near planes (gap below the mean radius; planes
/// without a window), those are taken away from outside that the probe reaches: it passes a facet when the circle
/// through the corners is larger than the mean radius of their grains by more than `probe` [m] (2D: half the gap of the
/// two, a foot being a point), and no facet on a plane. What is left is the specimen (alpha shape, Edelsbrunner and
/// Mücke 1994, but for holes that cannot be reached); of several pieces the largest one. It is closed: Σ outward = 0.
OuterSurface outer_surface(const State& state, double probe);

}  // namespace eg
