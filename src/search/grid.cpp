#include "search/grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "base/error.hpp"
#include "base/number.hpp"
#include "search/hits.hpp"

namespace eg {
namespace {

/// Parallelepiped that holds all grains, with fractional coordinates in [0, 1).
struct Frame {
  Vec3 origin;
  Mat3 to_fractional;
  std::array<bool, 3> periodic;
  std::array<double, 3> width;
};

Frame make_frame(const Grains& grains, const Cell& cell, double least_extent) {
  Mat3 h = cell.h;
  Vec3 origin = cell.origin;
  for (int k = 0; k < 3; ++k) {
    if (cell.periodic[static_cast<std::size_t>(k)]) continue;
    double low = INFINITY, high = -INFINITY;
    for (const auto& p : grains.position) low = std::min(low, p.vec()[k]), high = std::max(high, p.vec()[k]);
    const double extent = std::max(high - low, least_extent) * (1 + 1e-9);
    for (int r = 0; r < 3; ++r) h(r, k) = 0;
    h(k, k) = extent;
    origin[k] = low;
  }
  Cell box = cell;
  box.h = h;
  return {origin, inverse(h), cell.periodic, {box.width(0), box.width(1), box.width(2)}};
}

using Place = std::array<int, 3>;  // of a cell along each axis

struct Level {
  double largest = 0;  // radius [m]
  std::array<int, 3> n{1, 1, 1};
  bool wide = true;                 // along periodic directions the cells on both sides of one differ
  std::vector<Index> begin, items;  // grains of a cell: items[begin[c] … begin[c+1])
  std::vector<double> x, y, z, r;   // of the items in this order, and eight more that nothing reaches

  std::size_t cell(int a, int b, int c) const {
    return (static_cast<std::size_t>(c) * static_cast<std::size_t>(n[1]) + static_cast<std::size_t>(b)) *
               static_cast<std::size_t>(n[0]) +
           static_cast<std::size_t>(a);
  }
  Place place(std::size_t cell) const {
    const auto nx = static_cast<std::size_t>(n[0]), ny = static_cast<std::size_t>(n[1]);
    return {static_cast<int>(cell % nx), static_cast<int>(cell / nx % ny), static_cast<int>(cell / nx / ny)};
  }
};

Place place(const Frame& f, const Level& level, const Vec3& x) {
  const Vec3 s = f.to_fractional * (x - f.origin);
  Place p{};
  for (int k = 0; k < 3; ++k) {
    const auto u = static_cast<std::size_t>(k);
    p[u] = std::clamp(static_cast<int>(s[k] * level.n[u]), 0, level.n[u] - 1);
  }
  return p;
}

void fill(Level& level, const Frame& f, const Grains& grains, std::span<const Index> members, double skin) {
  const double size = 2 * level.largest + skin;
  for (std::size_t k = 0; k < 3; ++k) level.n[k] = static_cast<int>(std::clamp(f.width[k] / size, 1.0, 1024.0));
  while (1.0 * level.n[0] * level.n[1] * level.n[2] > 4.0 * static_cast<double>(members.size()) + 64)
    *std::max_element(level.n.begin(), level.n.end()) /= 2;  // sparse clouds need no finer grid than they have grains
  for (std::size_t k = 0; k < 3; ++k) level.wide = level.wide && (!f.periodic[k] || level.n[k] >= 3);
  level.begin.assign(level.cell(0, 0, level.n[2]) + 1, 0);
  std::vector<std::size_t> where(members.size());
  for (std::size_t m = 0; m < members.size(); ++m) {
    const Place p = place(f, level, grains.position[members[m]].vec());
    where[m] = level.cell(p[0], p[1], p[2]);
    ++level.begin[where[m] + 1];
  }
  for (std::size_t c = 1; c < level.begin.size(); ++c) level.begin[c] += level.begin[c - 1];
  level.items.resize(members.size());
  auto next = level.begin;
  for (std::size_t m = 0; m < members.size(); ++m) level.items[next[where[m]]++] = members[m];
  for (auto* v : {&level.x, &level.y, &level.z}) v->assign(members.size() + Batch::lanes, 1e150);
  level.r.assign(members.size() + Batch::lanes, 0);
  for (std::size_t m = 0; m < members.size(); ++m) {
    const Quad& p = grains.position[level.items[m]];
    level.x[m] = p.x, level.y[m] = p.y, level.z[m] = p.z, level.r[m] = p.w;
  }
}

/// A range of cells along x, begin ≤ a < end, of one row of cells, seen in one image.
struct Run {
  int begin, end, row, layer;
  std::uint8_t image;
  enum class Side {
    before,
    middle,
    after
  } side;  ///< of the cell asked about; of two cells one sees the other after it
};

/// Neighbours p − 1, p, p + 1 of a cell along one axis, each with the image that it lies in.
struct Near {
  std::array<int, 3> index{}, step{}, offset{};
  std::size_t count = 0;
  Near(const Frame& frame, const Level& level, const Place& p, std::size_t axis) {
    for (int o = -1; o <= 1; ++o) {
      int q = p[axis] + o, s = 0;
      if (q < 0 || q >= level.n[axis]) {
        if (!frame.periodic[axis]) continue;
        s = q < 0 ? -1 : 1;
        q -= s * level.n[axis];
      }
      index[count] = q, step[count] = s, offset[count++] = o;
    }
  }
};

/// Calls f(run) for the cells around a place, the middle one apart; every (cell, image) once. Cells that follow each
/// other in one image go together.
template <class F>
void around(const Frame& frame, const Level& level, const Place& p, F&& f) {
  const Near x(frame, level, p, 0), y(frame, level, p, 1), z(frame, level, p, 2);
  for (std::size_t c = 0; c < z.count; ++c)
    for (std::size_t b = 0; b < y.count; ++b) {
      const int rank = 3 * z.offset[c] + y.offset[b];
      for (std::size_t a = 0; a < x.count;) {
        std::size_t end = a + 1;
        if (rank != 0)
          while (end < x.count && x.step[end] == x.step[a]) ++end;
        const int place = rank != 0 ? rank : x.offset[a];
        f(Run{x.index[a], x.index[end - 1] + 1, y.index[b], z.index[c], Cell::code(x.step[a], y.step[b], z.step[c]),
              place < 0   ? Run::Side::before
              : place > 0 ? Run::Side::after
                          : Run::Side::middle});
        a = end;
      }
    }
}

/// Items of a run of cells.
struct Items {
  std::size_t begin, end;
  std::uint8_t image;
  Run::Side side;
  Items(const Level& level, const Run& run)
      : begin(level.begin[level.cell(run.begin, run.row, run.layer)]),
        end(level.begin[level.cell(run.end - 1, run.row, run.layer) + 1]),
        image(run.image),
        side(run.side) {}
};

/// Calls f(grain) for the items whose surfaces lie within `reach` of x.
template <class F>
EG_INLINE void visit(const Level& level, const Items& items, const Vec3& x, double reach, F&& f) {
  for (std::size_t m = items.begin; m < items.end; m += Batch::lanes) {
    const Batch dx = load_lanes(&level.x[m]) - Batch(x.x), dy = load_lanes(&level.y[m]) - Batch(x.y),
                dz = load_lanes(&level.z[m]) - Batch(x.z), far = load_lanes(&level.r[m]) + Batch(reach);
    visit_hits(dx * dx + dy * dy + dz * dz < far * far, items.end - m, [&](std::size_t k) { f(level.items[m + k]); });
  }
}

/// Some cells of a level.
struct Task {
  std::size_t level, begin, end;
};

/// Searches for the partners of the grains of some cells.
class Search {
 public:
  Search(const Grains& grains, const Cell& cell, const Frame& frame, const std::vector<Level>& levels, double skin)
      : grains_(grains), frame_(frame), levels_(levels), skin_(skin) {
    for (std::size_t c = 0; c < Cell::images; ++c) shift_[c] = cell.shift(static_cast<std::uint8_t>(c));
  }

  /// Each pair once: of one level, from the cell that comes first, or, where cells are too few for that to mean
  /// anything, from the grain with the lower number; of two levels, from the smaller grain.
  void run(const Task& task, std::vector<NearPair>& found) const {
    const Level& level = levels_[task.level];
    std::vector<Items> near;
    for (std::size_t c = task.begin; c < task.end; ++c) {
      if (level.begin[c] == level.begin[c + 1]) continue;
      near.clear();
      around(frame_, level, level.place(c), [&](const Run& run) {
        if (!level.wide || run.side != Run::Side::before) near.emplace_back(level, run);
      });
      for (std::size_t m = level.begin[c]; m < level.begin[c + 1]; ++m) {
        const Index i = level.items[m];
        for (const Items& items : near) partners(level, items, i, !level.wide || items.side != Run::Side::after, found);
        for (std::size_t l = task.level + 1; l < levels_.size(); ++l) {
          const Level& upper = levels_[l];
          if (!upper.items.empty())
            around(frame_, upper, place(frame_, upper, grains_.position[i].vec()),
                   [&](const Run& run) { partners(upper, Items(upper, run), i, false, found); });
        }
      }
    }
  }

 private:
  /// `lower`: only those with a higher number, or the grain itself in a later image.
  void partners(const Level& level, const Items& items, Index i, bool lower, std::vector<NearPair>& found) const {
    const Quad& a = grains_.position[i];
    visit(level, items, a.vec() - shift_[items.image], a.w + skin_, [&](Index j) {
      if (lower && (j < i || (j == i && items.image <= Cell::home))) return;
      found.push_back(i <= j ? NearPair{i, j, items.image}
                             : NearPair{j, i, static_cast<std::uint8_t>(26 - items.image)});
    });
  }

  const Grains& grains_;
  const Frame& frame_;
  const std::vector<Level>& levels_;
  double skin_;
  std::array<Vec3, Cell::images> shift_;
};

}  // namespace

std::vector<NearPair> find_pairs(const Grains& grains, const Cell& cell, double skin) {
  if (grains.size() == 0) return {};
  double smallest = INFINITY, largest = 0;
  for (const auto& p : grains.position) {
    if (!std::isfinite(p.x + p.y + p.z))
      throw RunError("a grain's position is not finite: the step was unstable; use a smaller one");
    smallest = std::min(smallest, p.w), largest = std::max(largest, p.w);
  }
  const Frame frame = make_frame(grains, cell, 2 * largest);
  for (std::size_t k = 0; k < 3; ++k)
    if (frame.periodic[k] && frame.width[k] < 2 * largest + skin)
      throw RunError(fmt::format(
          "the periodic cell is {:.6g} m wide along {}, less than the largest diameter plus the list's skin, "
          "{:.6g} m: use more grains or more lattice cells",
          frame.width[k], "xyz"[k], 2 * largest + skin));

  const auto class_of = [&](double r) { return static_cast<std::size_t>(std::log2(r / smallest) + 1e-9); };
  std::vector<Level> levels(class_of(largest) + 1);
  std::vector<std::vector<Index>> members(levels.size());
  for (std::size_t i = 0; i < grains.size(); ++i) {
    const auto l = class_of(grains.radius(i));
    members[l].push_back(static_cast<Index>(i));
    levels[l].largest = std::max(levels[l].largest, grains.radius(i));
  }
  for (std::size_t l = 0; l < levels.size(); ++l)
    if (!members[l].empty()) fill(levels[l], frame, grains, members[l], skin);

  std::vector<Task> tasks;
  constexpr std::size_t cells = 1024;
  for (std::size_t l = 0; l < levels.size(); ++l)
    for (std::size_t c = 0; c + 1 < levels[l].begin.size(); c += cells)
      tasks.push_back({l, c, std::min(c + cells, levels[l].begin.size() - 1)});
  const Search search(grains, cell, frame, levels, skin);
  std::vector<std::vector<NearPair>> found(tasks.size());
#pragma omp parallel for schedule(dynamic) if (tasks.size() > 1)
  for (std::size_t k = 0; k < tasks.size(); ++k) search.run(tasks[k], found[k]);
  std::vector<NearPair> all;
  std::size_t total = 0;
  for (const auto& f : found) total += f.size();
  all.reserve(total);
  for (const auto& f : found) all.insert(all.end(), f.begin(), f.end());
  return all;
}

}  // namespace eg
