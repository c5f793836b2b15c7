#pragma once
// Delaunay tessellation of points, the same in two and three dimensions.
#include <array>
#include <vector>

#include "base/vec.hpp"

namespace eg {

/// Tetrahedra, in 2D triangles, and the cells around them: those reach from a facet of the hull to a corner at
/// infinity, no_index. Cells have dimension + 1 corners, a right-handed frame in their order (2D: counter-clockwise);
/// the rest of the arrays is not read.
struct Tessellation {
  std::vector<std::array<Index, 4>> corners;     ///< points of a cell
  std::vector<std::array<Index, 4>> neighbours;  ///< the cell beyond the facet opposite the corner
  bool finite(std::size_t cell, int dimension) const {
    for (std::size_t k = 0; k <= static_cast<std::size_t>(dimension); ++k)
      if (corners[cell][k] == no_index) return false;
    return true;
  }
};

/// Exact whatever the points (CGAL); where more of them lie on a common sphere than a cell has corners, the choice
/// among the possible cells depends on their coordinates alone. Of coinciding points one is taken. No cells when all
/// points lie in one plane (2D: line).
Tessellation delaunay(int dimension, const std::vector<Vec3>& points);

}  // namespace eg
