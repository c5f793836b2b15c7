#include "search/wall_contacts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.hpp"
#include "state/friction.hpp"
#include "state/wall_geometry.hpp"

namespace eg {
namespace {

/// Grains by x, to find those near a part of a mesh.
class ByX {
 public:
  explicit ByX(const Grains& grains) : order_(grains.size()), x_(grains.size()) {
    std::iota(order_.begin(), order_.end(), Index{0});
    std::ranges::sort(order_, {}, [&](Index g) { return grains.position[g].x; });
    for (std::size_t k = 0; k < order_.size(); ++k) {
      x_[k] = grains.position[order_[k]].x;
      reach_ = std::max(reach_, grains.radius(k));
    }
  }
  /// Calls visit(grain) for all whose surface may lie within [low − margin, high + margin] along x.
  template <class Visit>
  void between(double low, double high, double margin, Visit&& visit) const {
    const auto first = std::ranges::lower_bound(x_, low - margin - reach_);
    for (auto at = first; at != x_.end() && *at <= high + margin + reach_; ++at)
      visit(order_[static_cast<std::size_t>(at - x_.begin())]);
  }

 private:
  std::vector<Index> order_;
  std::vector<double> x_;
  double reach_ = 0;
};

[[noreturn]] void report_lost(const State& state, Index grain, Index wall) {
  const Vec3 x = state.grains.position[grain].vec();
  throw RunError(fmt::format(
      "step {}: grain {} went through wall {} and is lost, at ({:.6g}, {:.6g}, {:.6g}) m; the wall moves too fast, is "
      "too soft or too heavily loaded: lower its speed or the load, or raise the stiffness",
      state.step, state.grains.id[grain], wall + 1, x.x, x.y, x.z));
}

WallContact contact(const State& state, Index grain, Index wall) {
  return {grain, wall, {}, wall_friction_factor(state.friction_scatter, state.grains.id[grain], wall)};
}

void add_if_near(const State& state, Index wall_index, Index grain, std::vector<WallContact>& fresh) {
  const Wall& wall = state.walls[wall_index];
  const Quad& p = state.grains.position[grain];
  const double skin = wall_skin(state.list);
  if (std::abs(off_window(wall, p.vec())) > p.w + skin) return;
  const double overlap = grain_surface(state, wall, p.vec(), p.w, Arms::middle).overlap;
  if (overlap > -skin) fresh.push_back(contact(state, grain, wall_index));
  if (overlap > 2 * p.w && !wall.windowed() && state.grains.velocity[grain].w > 0)
    report_lost(state, grain, wall_index);
}

/// Grains near planes and cylinders, wall by wall, by their number. One look at a grain is enough for all walls, and
/// most are far from any plane, which its normal alone tells.
std::vector<std::vector<WallContact>> near_surfaces(const State& state) {
  std::vector<std::vector<WallContact>> near(state.walls.size());
  std::vector<Index> surfaces;
  for (Index w = 0; w < state.walls.size(); ++w)
    if (state.walls[w].shape < Wall::face) surfaces.push_back(w);
  const double skin = wall_skin(state.list);
  for (Index g = 0; g < state.grains.size() && !surfaces.empty(); ++g) {
    const Quad p = state.grains.position[g];
    for (const Index w : surfaces) {
      const Wall& wall = state.walls[w];
      if (wall.shape == Wall::plane && dot(p.vec() - wall.point, wall.normal) > p.w + skin) continue;
      add_if_near(state, w, g, near[w]);
    }
  }
  return near;
}

struct Extent {
  Vec3 low, high;
};

/// Of a face, rim or tip.
Extent extent_of(const Wall& wall) {
  std::array<Vec3, 2> reach{};
  if (wall.shape == Wall::face) reach = {wall.side_b, wall.side_c};
  if (wall.shape == Wall::rim) reach[0] = wall.normal * wall.length;
  Extent e{wall.point, wall.point};
  for (const Vec3& r : reach)
    for (int k = 0; k < 3; ++k)
      e.low[k] = std::min(e.low[k], wall.point[k] + r[k]), e.high[k] = std::max(e.high[k], wall.point[k] + r[k]);
  return e;
}

bool within(const Extent& e, const Vec3& x, double margin) {
  for (int k = 0; k < 3; ++k)
    if (x[k] < e.low[k] - margin || x[k] > e.high[k] + margin) return false;
  return true;
}

/// Whether a part of a mesh is touched depends on where the grain's foot lies, which may change: all near it are
/// listed.
void add_near_part(const State& state, Index w, const ByX& by_x, std::vector<WallContact>& fresh) {
  const Wall& wall = state.walls[w];
  const Extent extent = extent_of(wall);
  const double skin = wall_skin(state.list);
  const std::size_t before = fresh.size();
  by_x.between(extent.low.x, extent.high.x, skin, [&](Index g) {
    const Quad& p = state.grains.position[g];
    const double reach = p.w + skin;
    if (!within(extent, p.vec(), reach)) return;
    if (wall.shape == Wall::face && std::abs(dot(p.vec() - wall.point, wall.normal)) > reach) return;
    fresh.push_back(contact(state, g, w));
  });
  std::sort(fresh.begin() + static_cast<std::ptrdiff_t>(before), fresh.end(),
            [](const WallContact& a, const WallContact& b) { return a.grain < b.grain; });
}

/// A grain that has left the box around a mesh with grains inside.
void check_kept(const State& state) {
  for (Index b = 0; b < state.bodies.size(); ++b) {
    Extent all{{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    Index last = no_index;
    for (Index w = 0; w < state.walls.size(); ++w) {
      const Wall& wall = state.walls[w];
      if (wall.body != b || wall.shape != Wall::face || !wall.hollow) continue;
      const Extent e = extent_of(wall);
      for (int k = 0; k < 3; ++k)
        all.low[k] = std::min(all.low[k], e.low[k]), all.high[k] = std::max(all.high[k], e.high[k]);
      last = w;
    }
    if (last == no_index) continue;
    for (Index g = 0; g < state.grains.size(); ++g)
      if (!within(all, state.grains.position[g].vec(), state.grains.radius(g))) report_lost(state, g, last);
  }
}

}  // namespace

void refresh_wall_contacts(State& state) {
  if (state.walls.empty()) return;
  std::vector<WallContact> fresh;
  const bool meshes = std::ranges::any_of(state.walls, [](const Wall& w) { return w.shape >= Wall::face; });
  const ByX by_x(meshes ? state.grains : Grains{});
  const auto near = near_surfaces(state);
  for (Index w = 0; w < state.walls.size(); ++w) {
    state.walls[w].moved = 0;
    if (state.walls[w].shape >= Wall::face)
      add_near_part(state, w, by_x, fresh);
    else
      fresh.insert(fresh.end(), near[w].begin(), near[w].end());
  }
  check_kept(state);
  const auto less = [](const WallContact& a, const WallContact& b) {
    return a.wall != b.wall ? a.wall < b.wall : a.grain < b.grain;
  };
  auto& old = state.wall_contacts;
  if (!std::is_sorted(old.begin(), old.end(), less)) std::sort(old.begin(), old.end(), less);
  auto o = old.begin();
  for (auto& f : fresh) {
    while (o != old.end() && less(*o, f)) ++o;
    if (o != old.end() && !less(f, *o)) f.history = o->history;
  }
  old = std::move(fresh);
}

}  // namespace eg
