#pragma once
// Paths through the Brillouin zone. Wave vectors are named, or given in units of 2π over the edges of the conventional
// (rectangular) cell of the lattice, as crystallographers do; for a packing that is no lattice, over those of its cell.
#include <string>
#include <string_view>
#include <vector>

#include "base/vec.hpp"

namespace eg {

struct ZonePoint {
  std::string name;  ///< "G" is Γ, k = 0
  Vec3 reduced;      ///< k over 2π/edges
};

/// The points of high symmetry of a lattice of specimen/lattice.hpp; for another name those of a rectangular cell
/// (2D: `dimension` = 2).
std::vector<ZonePoint> zone_points(std::string_view lattice, int dimension);

/// A path through all of them, in words for parse_zone_path().
std::string usual_path(std::string_view lattice, int dimension);

/// "G X 0.5,0.5,0 R": names and numbers with commas, at least two, blanks between. Throws InputError for anything else.
std::vector<ZonePoint> parse_zone_path(const std::string& text, std::string_view lattice, int dimension);

/// k [rad/m] of a reduced wave vector in a cell with these edges (columns).
Vec3 wave_vector(const Mat3& edges, const Vec3& reduced);

/// "Γ" for "G", else the name itself.
std::string shown_name(const std::string& name);

}  // namespace eg
