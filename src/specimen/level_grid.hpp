#pragma once
// Finds possible overlaps among spheres of very different sizes: one cell grid a size class, each class half as large
// as the one before (Ogarkov and Luding 2012). A sphere asks its own grid and the coarser ones, 27 cells each.
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "base/vec.hpp"

namespace eg {

/// The box in which spheres lie: edges from 0, periodic or closed by walls.
struct Box {
  Vec3 edges;  ///< [m]
  std::array<bool, 3> periodic{};

  /// The shortest of all images of a branch vector between two points of the box.
  Vec3 nearest(Vec3 branch) const {
    for (int k = 0; k < 3; ++k) {
      if (!periodic[static_cast<std::size_t>(k)]) continue;
      if (branch[k] > 0.5 * edges[k]) branch[k] -= edges[k];
      if (branch[k] < -0.5 * edges[k]) branch[k] += edges[k];
    }
    return branch;
  }
};

class LevelGrid {
 public:
  /// Room for `count` spheres with radii [m] within [smallest, largest].
  LevelGrid(const Box&, double smallest, double largest, std::size_t count);

  void clear();
  /// Enters sphere `i` < count; x in [0, edges].
  void insert(Index i, const Vec3& x, double radius);
  /// Calls visit(j) once for every sphere entered so far that is of the size class of `radius` or a larger one and may
  /// overlap a sphere at x, until visit returns false. Returns whether it never did.
  template <class Visit>
  bool for_each_near(const Vec3& x, double radius, Visit&& visit) const;

 private:
  struct Level {
    double cutoff;  ///< largest radius of the class [m]
    std::array<int, 3> cells;
    std::vector<Index> first;  ///< first sphere of each cell; the rest are chained by next_
  };
  std::size_t level_of(double radius) const;
  std::array<int, 3> cell_of(const Level&, const Vec3& x) const;
  /// Cells c − 1, c, c + 1 along direction k, each once and inside the box.
  int neighbours(const Level&, int k, int c, std::array<int, 3>& found) const;

  Box box_;
  std::vector<Level> levels_;
  std::vector<Index> next_;
};

template <class Visit>
bool LevelGrid::for_each_near(const Vec3& x, double radius, Visit&& visit) const {
  for (std::size_t l = 0; l <= level_of(radius); ++l) {
    const Level& level = levels_[l];
    const auto centre = cell_of(level, x);
    std::array<std::array<int, 3>, 3> near{};
    std::array<int, 3> count{};
    for (std::size_t k = 0; k < 3; ++k) count[k] = neighbours(level, static_cast<int>(k), centre[k], near[k]);
    for (int c = 0; c < count[2]; ++c)
      for (int b = 0; b < count[1]; ++b)
        for (int a = 0; a < count[0]; ++a) {
          const auto cell = static_cast<std::size_t>(near[0][a]) +
                            static_cast<std::size_t>(level.cells[0]) *
                                (static_cast<std::size_t>(near[1][b]) +
                                 static_cast<std::size_t>(level.cells[1]) * static_cast<std::size_t>(near[2][c]));
          for (Index j = level.first[cell]; j != no_index; j = next_[j])
            if (!visit(j)) return false;
        }
  }
  return true;
}

}  // namespace eg
