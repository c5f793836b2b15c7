#include "specimen/level_grid.hpp"

#include <algorithm>

namespace eg {

LevelGrid::LevelGrid(const Box& box, double smallest, double largest, std::size_t count) : box_(box), next_(count) {
  const double most_cells = 8.0 * static_cast<double>(count) + 64;
  for (double cutoff = largest;; cutoff /= 2) {
    Level level{cutoff, {}, {}};
    double size = 2 * cutoff;
    const double cells = box.edges.x / size * std::max(1.0, box.edges.y / size) * std::max(1.0, box.edges.z / size);
    if (cells > most_cells) size *= std::cbrt(cells / most_cells);  // sparse: larger cells do as well
    std::size_t total = 1;
    for (std::size_t k = 0; k < 3; ++k) {
      level.cells[k] = std::max(1, static_cast<int>(box.edges[static_cast<int>(k)] / size));
      total *= static_cast<std::size_t>(level.cells[k]);
    }
    level.first.assign(total, no_index);
    levels_.push_back(std::move(level));
    if (cutoff / 2 < smallest) break;
  }
}

void LevelGrid::clear() {
  for (auto& level : levels_) std::fill(level.first.begin(), level.first.end(), no_index);
}

void LevelGrid::insert(Index i, const Vec3& x, double radius) {
  Level& level = levels_[level_of(radius)];
  const auto [a, b, c] = cell_of(level, x);
  const auto cell =
      static_cast<std::size_t>(a) +
      static_cast<std::size_t>(level.cells[0]) *
          (static_cast<std::size_t>(b) + static_cast<std::size_t>(level.cells[1]) * static_cast<std::size_t>(c));
  next_[i] = level.first[cell];
  level.first[cell] = i;
}

std::size_t LevelGrid::level_of(double radius) const {
  std::size_t l = 0;
  while (l + 1 < levels_.size() && radius <= levels_[l + 1].cutoff) ++l;
  return l;
}

std::array<int, 3> LevelGrid::cell_of(const Level& level, const Vec3& x) const {
  std::array<int, 3> cell{};
  for (std::size_t k = 0; k < 3; ++k) {
    const int i = static_cast<int>(k);
    cell[k] = std::clamp(static_cast<int>(x[i] / box_.edges[i] * level.cells[k]), 0, level.cells[k] - 1);
  }
  return cell;
}

int LevelGrid::neighbours(const Level& level, int k, int c, std::array<int, 3>& found) const {
  const int cells = level.cells[static_cast<std::size_t>(k)];
  int count = 0;
  if (!box_.periodic[static_cast<std::size_t>(k)]) {
    for (int i = std::max(0, c - 1); i <= std::min(cells - 1, c + 1); ++i) found[static_cast<std::size_t>(count++)] = i;
  } else if (cells < 3) {
    for (int i = 0; i < cells; ++i) found[static_cast<std::size_t>(count++)] = i;
  } else {
    for (int i = c - 1; i <= c + 1; ++i) found[static_cast<std::size_t>(count++)] = (i + cells) % cells;
  }
  return count;
}

}  // namespace eg
