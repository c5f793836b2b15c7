#include "boundary/outer_surface.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "boundary/tessellation.hpp"
#include "measure/volume.hpp"

namespace eg {
namespace {

/// Centres of grains, then feet.
struct Points {
  std::vector<Vec3> at;
  std::vector<Index> grain;
  std::vector<std::uint64_t> planes;

  void add(const Vec3& x, Index g, std::uint64_t on) { at.push_back(x), grain.push_back(g), planes.push_back(on); }
};

Points points_of(const State& state) {
  std::vector<const Wall*> planes;
  for (const auto& wall : state.walls)
    if (wall.shape == Wall::plane && !wall.windowed() && planes.size() < 64) planes.push_back(&wall);
  const auto& position = state.grains.position;
  double mean = 0;
  for (const auto& p : position) mean += p.w / static_cast<double>(position.size());
  Points points;
  for (Index g = 0; g < position.size(); ++g) points.add(position[g].vec(), g, 0);
  for (Index g = 0; g < position.size(); ++g) {
    // Near several planes a grain has a foot on each, on their edges and in their corner.
    std::vector<std::pair<Vec3, std::uint64_t>> feet{{position[g].vec(), 0}};
    for (std::size_t k = 0; k < planes.size(); ++k) {
      const double height = dot(position[g].vec() - planes[k]->point, planes[k]->normal);
      if (height > position[g].w + mean) continue;
      for (std::size_t f = 0, count = feet.size(); f < count; ++f) {
        const auto [x, on] = feet[f];
        feet.push_back({x - planes[k]->normal * dot(x - planes[k]->point, planes[k]->normal), on | 1ull << k});
      }
    }
    for (std::size_t f = 1; f < feet.size(); ++f) points.add(feet[f].first, g, feet[f].second);
  }
  return points;
}

/// The specimen as cells of a tessellation.
class Carving {
 public:
  Carving(const State& state, double probe)
      : state_(state),
        dimension_(state.dimension),
        corners_(static_cast<std::size_t>(state.dimension) + 1),
        points_(points_of(state)),
        mesh_(delaunay(state.dimension, points_.at)),
        piece_(mesh_.corners.size(), unknown) {
    carve(probe);
    keep_largest();
  }

  OuterSurface surface() const {
    OuterSurface out;
    std::vector<double> angle(state_.grains.size());
    std::vector<bool> inside(state_.grains.size());
    for (std::size_t c = 0; c < piece_.size(); ++c) {
      if (piece_[c] != specimen_) continue;
      out.volume += cell_volume(c);
      for (std::size_t k = 0; k < corners_; ++k) {
        const Index p = mesh_.corners[c][k];
        if (p < state_.grains.size()) angle[p] += solid_angle(c, k), inside[p] = true;
        if (piece_[mesh_.neighbours[c][k]] != specimen_) out.facets.push_back(facet(c, k));
      }
    }
    const double full = dimension_ == 3 ? 4 * std::numbers::pi : 2 * std::numbers::pi;
    for (Index g = 0; g < angle.size(); ++g) {
      if (!inside[g]) out.lost.push_back(g);
      out.solid += std::min(1.0, angle[g] / full) * grain_volume(dimension_, state_.grains.radius(g));
    }
    return out;
  }

 private:
  static constexpr int outside = -1, unknown = -2;

  const Vec3& corner(std::size_t cell, std::size_t k) const { return points_.at[mesh_.corners[cell][k]]; }

  /// The corners of the facet opposite corner k, as points.
  std::array<Index, 3> facet_points(std::size_t cell, std::size_t k) const {
    std::array<Index, 3> p{};
    for (std::size_t i = 1; i < corners_; ++i) p[i - 1] = mesh_.corners[cell][(k + i) % corners_];
    return p;
  }

  std::uint64_t planes_of(const std::array<Index, 3>& p) const {
    const std::uint64_t two = points_.planes[p[0]] & points_.planes[p[1]];
    return dimension_ == 3 ? two & points_.planes[p[2]] : two;
  }

  bool passes(const std::array<Index, 3>& p, double probe) const {
    const auto radius = [&](std::size_t k) { return state_.grains.radius(points_.grain[p[k]]); };
    const auto own = [&](std::size_t k) { return points_.planes[p[k]] == 0 ? radius(k) : 0.0; };
    const auto at = [&](std::size_t k) { return points_.at[p[k]]; };
    if (dimension_ == 2) return 0.5 * (norm(at(1) - at(0)) - own(0) - own(1)) > probe;
    const Vec3 a = at(1) - at(0), b = at(2) - at(0);
    const double circle = norm(a) * norm(b) * norm(a - b) / (2 * norm(cross(a, b)));
    return circle - (radius(0) + radius(1) + radius(2)) / 3 > probe;
  }

  /// Marks all that the probe reaches from infinity.
  void carve(double probe) {
    std::vector<std::size_t> front;
    for (std::size_t c = 0; c < piece_.size(); ++c)
      if (!mesh_.finite(c, dimension_)) piece_[c] = outside, front.push_back(c);
    while (!front.empty()) {
      const std::size_t c = front.back();
      front.pop_back();
      for (std::size_t k = 0; k < corners_; ++k) {
        const Index next = mesh_.neighbours[c][k];
        if (piece_[next] == outside) continue;
        const auto p = facet_points(c, k);
        if (planes_of(p) != 0 || !passes(p, probe)) continue;
        piece_[next] = outside, front.push_back(next);
      }
    }
  }

  /// Numbers the pieces that are left, told apart by facets; the largest one is the specimen.
  void keep_largest() {
    int pieces = 0;
    double most = 0;
    for (std::size_t first = 0; first < piece_.size(); ++first) {
      if (piece_[first] != unknown) continue;
      double volume = 0;
      std::vector<std::size_t> front{first};
      piece_[first] = pieces;
      while (!front.empty()) {
        const std::size_t c = front.back();
        front.pop_back();
        volume += cell_volume(c);
        for (std::size_t k = 0; k < corners_; ++k)
          if (const Index next = mesh_.neighbours[c][k]; piece_[next] == unknown)
            piece_[next] = pieces, front.push_back(next);
      }
      if (volume > most) most = volume, specimen_ = pieces;
      ++pieces;
    }
  }

  double cell_volume(std::size_t c) const {
    const Vec3 a = corner(c, 1) - corner(c, 0), b = corner(c, 2) - corner(c, 0);
    if (dimension_ == 2) return 0.5 * std::abs(cross(a, b).z);
    return std::abs(dot(cross(a, b), corner(c, 3) - corner(c, 0))) / 6;
  }

  /// At corner k (Van Oosterom and Strackee 1983) [sr], in 2D the angle [rad].
  double solid_angle(std::size_t c, std::size_t k) const {
    const auto p = facet_points(c, k);
    const auto from = [&](std::size_t i) { return points_.at[p[i]] - corner(c, k); };
    const Vec3 x = from(0), y = from(1);
    if (dimension_ == 2) return std::abs(std::atan2(cross(x, y).z, dot(x, y)));
    const Vec3 z = from(2);
    const double nx = norm(x), ny = norm(y), nz = norm(z);
    const double below = nx * ny * nz + dot(x, y) * nz + dot(x, z) * ny + dot(y, z) * nx;
    return 2 * std::abs(std::atan2(std::abs(dot(x, cross(y, z))), below));
  }

  SurfaceFacet facet(std::size_t c, std::size_t k) const {
    const auto p = facet_points(c, k);
    SurfaceFacet f;
    f.planes = planes_of(p);
    const auto sides = static_cast<std::size_t>(dimension_);
    for (std::size_t i = 0; i < sides; ++i) f.corner[i] = points_.at[p[i]], f.grain[i] = points_.grain[p[i]];
    if (dimension_ == 3 && k % 2 == 1) std::swap(f.corner[0], f.corner[1]), std::swap(f.grain[0], f.grain[1]);
    return f;
  }

  const State& state_;
  int dimension_;
  std::size_t corners_;  ///< of a cell
  Points points_;
  Tessellation mesh_;
  std::vector<int> piece_;  ///< a cell's
  int specimen_ = 0;
};

}  // namespace

Vec3 SurfaceFacet::outward(int dimension) const {
  const Vec3 a = corner[1] - corner[0];
  return dimension == 2 ? Vec3{a.y, -a.x, 0} : 0.5 * cross(a, corner[2] - corner[0]);
}

OuterSurface outer_surface(const State& state, double probe) { return Carving(state, probe).surface(); }

}  // namespace eg
