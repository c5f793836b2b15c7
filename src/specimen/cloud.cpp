#include "specimen/cloud.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "base/error.hpp"
#include "base/progress.hpp"
#include "specimen/level_grid.hpp"

namespace eg {

namespace {

// Gaps over the sum of two radii. One is kept, so that no other formula's round-off finds an overlap; a wider one is
// aimed at when pushing apart, so that the end comes in few sweeps.
constexpr double gap = 1e-6;
constexpr double push_gap = 0.02;
constexpr double push_factor = 2;      // over-relaxation of the mean push; disks diverge from 3 on
constexpr std::size_t attempts = 100;  // to insert a grain, on average
constexpr int most_sweeps = 2000;

double solid_volume(std::span<const double> radii, int dimension) {
  double sum = 0;
  for (const double r : radii) sum += dimension == 3 ? r * r * r : r * r;
  return sum * std::numbers::pi * (dimension == 3 ? 4. / 3 : 1);
}

Vec3 box_edges(double volume, const CloudSpec& spec) {
  if (spec.box.x > 0) return {spec.box.x, spec.box.y, spec.dimension == 3 ? spec.box.z : 1};
  const auto [x, y, z] = spec.aspect;
  if (spec.dimension == 3) return std::cbrt(volume / (x * y * z)) * Vec3{x, y, z};
  const double scale = std::sqrt(volume / (x * y));
  return {scale * x, scale * y, 1};
}

class Cloud {
 public:
  Cloud(std::span<const double> radii, const Packing& packing)
      : radii_(radii),
        dimension_(packing.dimension),
        box_{packing.box, packing.periodic},
        order_(radii.size()),
        position_(radii.size()),
        grid_(grid(radii)) {
    std::iota(order_.begin(), order_.end(), Index{0});
    std::stable_sort(order_.begin(), order_.end(), [&](Index a, Index b) { return radii_[a] > radii_[b]; });
  }

  /// Inserts grains without overlap, largest first, and anywhere once the attempts are used up.
  /// Returns whether they lasted.
  bool insert(Random& random) {
    std::size_t left = attempts * radii_.size(), done = 0;
    Progress progress("placing grains", static_cast<double>(radii_.size()), "grains");
    progress.every(2, 10);
    for (const Index i : order_) {
      progress.update(static_cast<double>(done++));
      position_[i] = anywhere(i, random);
      for (; left > 0 && !is_free(i); --left) position_[i] = anywhere(i, random);
      grid_.insert(i, position_[i], reach(i));
    }
    return left > 0;
  }

  /// Pushes every overlapping pair apart by the mean of what its contacts ask for. Returns whether no overlap is left.
  bool push_apart() {
    Progress progress("pushing grains apart", 0, "sweeps");
    progress.every(2, 10);
    for (int sweep = 0; sweep < most_sweeps; ++sweep) {
      progress.update(sweep);
      if (push_once() >= gap) return true;
    }
    return false;
  }

  std::vector<Vec3> take_positions() { return std::move(position_); }

 private:
  LevelGrid grid(std::span<const double> radii) const {
    const auto [low, high] = std::minmax_element(radii.begin(), radii.end());
    return {box_, *low * (1 + push_gap), *high * (1 + push_gap), radii.size()};
  }
  double reach(Index i) const { return radii_[i] * (1 + push_gap); }

  Vec3 anywhere(Index i, Random& random) const {
    Vec3 x;
    for (int k = 0; k < dimension_; ++k) {
      const double wall = box_.periodic[static_cast<std::size_t>(k)] ? 0 : radii_[i] * (1 + gap);
      x[k] = random.uniform(wall, box_.edges[k] - wall);
    }
    return x;
  }

  bool is_free(Index i) const {
    return grid_.for_each_near(position_[i], reach(i), [&](Index j) {
      const Vec3 branch = box_.nearest(position_[j] - position_[i]);
      const double distance = (radii_[i] + radii_[j]) * (1 + gap);
      return dot(branch, branch) >= distance * distance;
    });
  }

  /// One sweep; returns the smallest gap before it, over the sum of radii (at most push_gap).
  double push_once() {
    double smallest = push_gap;
    std::vector<Vec3> push(radii_.size());
    std::vector<int> pushes(radii_.size());
    grid_.clear();
    for (const Index i : order_) {
      grid_.for_each_near(position_[i], reach(i), [&](Index j) {
        const Vec3 branch = box_.nearest(position_[j] - position_[i]);
        const double touch = radii_[i] + radii_[j], distance = norm(branch);
        const double missing = touch * (1 + push_gap) - distance;
        if (missing <= 0) return true;
        smallest = std::min(smallest, distance / touch - 1);
        const Vec3 normal = distance > 0 ? (1 / distance) * branch : Vec3{1, 0, 0};
        push[i] -= missing * radii_[j] / touch * normal;
        push[j] += missing * radii_[i] / touch * normal;
        ++pushes[i], ++pushes[j];
        return true;
      });
      grid_.insert(i, position_[i], reach(i));
    }
    if (smallest < gap)
      for (Index i = 0; i < radii_.size(); ++i)
        if (pushes[i] > 0) move(i, push_factor / pushes[i] * push[i]);
    return smallest;
  }

  void move(Index i, const Vec3& by) {
    for (int k = 0; k < dimension_; ++k) {
      double x = position_[i][k] + by[k];
      const double edge = box_.edges[k], wall = radii_[i] * (1 + gap);
      if (box_.periodic[static_cast<std::size_t>(k)]) {
        x -= edge * std::floor(x / edge);
        if (x >= edge) x = 0;  // round-off of a tiny negative x
      } else {
        x = std::clamp(x, wall, edge - wall);
      }
      position_[i][k] = x;
    }
  }

  std::span<const double> radii_;
  int dimension_;
  Box box_;
  std::vector<Index> order_;  // by radius, largest first
  std::vector<Vec3> position_;
  LevelGrid grid_;
};

}  // namespace

Packing make_cloud(std::span<const double> radii, const CloudSpec& spec, Random& random) {
  assert(!radii.empty() && spec.solid_fraction > 0);
  Packing packing;
  packing.dimension = spec.dimension;
  packing.box = box_edges(solid_volume(radii, spec.dimension) / spec.solid_fraction, spec);
  packing.periodic = {spec.periodic, spec.periodic, spec.periodic && spec.dimension == 3};
  packing.radius.assign(radii.begin(), radii.end());
  const double largest = 2 * (1 + push_gap) * *std::max_element(radii.begin(), radii.end());
  for (int k = 0; k < spec.dimension; ++k)
    if (packing.box[k] < largest)
      throw RunError(
          fmt::format("cloud of {} grains: box edge {:.4g} m is narrower than the largest grain, {:.4g} m; "
                      "take more grains, a lower solid fraction or a less slender box",
                      radii.size(), packing.box[k], largest));

  Cloud cloud(radii, packing);
  if (!cloud.insert(random) && !cloud.push_apart())
    throw RunError(fmt::format(
        "cloud of {} grains: solid fraction {:.4g} not reached without overlap; "
        "lower specimen.solid_fraction, or enlarge its box, and compress the cloud instead",
        radii.size(), solid_volume(radii, spec.dimension) / (packing.box.x * packing.box.y * packing.box.z)));
  packing.position = cloud.take_positions();
  return packing;
}

}  // namespace eg
