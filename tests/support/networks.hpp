#pragma once
// Networks made by hand for tests: lattices of unit grains and random packings.
#include <cmath>
#include <string>
#include <vector>

#include "assembly/network.hpp"
#include "base/random.hpp"

namespace eg::test {

struct Points {
  int dimension = 3;
  Vec3 box;  ///< periodic edges
  std::vector<Vec3> position;
  double distance = 1;  ///< of nearest neighbours
};

/// "sc", "bcc", "fcc", "square", "hexagonal": cells³ (cells²) conventional cells, nearest neighbours at distance 1.
inline Points lattice_points(const std::string& name, int cells) {
  Points points;
  std::vector<Vec3> basis{{0, 0, 0}};
  Vec3 cell{1, 1, 1};
  if (name == "bcc") cell = Vec3{1, 1, 1} * (2 / std::sqrt(3.0)), basis.push_back({.5, .5, .5});
  if (name == "fcc") {
    cell = Vec3{1, 1, 1} * std::sqrt(2.0);
    basis.insert(basis.end(), {Vec3{0, .5, .5}, Vec3{.5, 0, .5}, Vec3{.5, .5, 0}});
  }
  if (name == "hexagonal") cell = {1, std::sqrt(3.0), 1}, basis.push_back({.5, .5, 0});
  if (name == "square" || name == "hexagonal") points.dimension = 2;
  const int layers = points.dimension == 3 ? cells : 1;
  points.box = {cell.x * cells, cell.y * cells, cell.z * layers};
  for (int z = 0; z < layers; ++z)
    for (int y = 0; y < cells; ++y)
      for (int x = 0; x < cells; ++x)
        for (const Vec3& b : basis)
          points.position.push_back({(x + b.x) * cell.x, (y + b.y) * cell.y, (z + b.z) * cell.z});
  return points;
}

/// Equal grains of mass 1 and diameter 1 on a periodic lattice, springs kn, kt between neighbours at distance 1.
inline Network lattice_network(const std::string& name, int cells, double kn, double kt, bool rotation) {
  const Points points = lattice_points(name, cells);
  Network network;
  network.dimension = points.dimension;
  network.rotation = rotation;
  const std::size_t n = points.position.size();
  network.inverse_mass.assign(n, 1.0);
  if (rotation) network.inverse_inertia.assign(n, points.dimension == 3 ? 1 / (.4 * .25) : 1 / (.5 * .25));
  network.radius.assign(n, 0.5);
  for (std::size_t i = 0; i < n; ++i) network.id.push_back(static_cast<Index>(i));
  const int depth = points.dimension == 3 ? 1 : 0;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i; j < n; ++j)
      for (int z = -depth; z <= depth; ++z)
        for (int y = -1; y <= 1; ++y)
          for (int x = -1; x <= 1; ++x) {
            if (i == j && (z < 0 || (z == 0 && (y < 0 || (y == 0 && x <= 0))))) continue;  // each self-image pair once
            const Vec3 image{x * points.box.x, y * points.box.y, z * points.box.z};
            const Vec3 branch = points.position[j] + image - points.position[i];
            const double d = norm(branch);
            if (std::abs(d - 1) > 1e-6) continue;
            network.springs.push_back(
                {static_cast<Index>(i), static_cast<Index>(j), .5, .5, kn, kt, (1 / d) * branch, d});
          }
  return network;
}

struct RandomNetworkOptions {
  int dimension = 3;
  bool rotation = true;
  std::size_t grains = 12;
  double size_ratio = 3;          ///< largest over smallest radius, log-uniform
  double tangential_ratio = 0.8;  ///< kt / kn; < 0: random in [0, 1] for every contact
  double wall_share = 0.1;        ///< chance that a grain also touches a wall
  double fixed_share = 0;         ///< chance that a grain cannot move
  double crowding = 1.3;          ///< grains that overlap when radii are this much larger are joined
};

/// Grains dropped at random into a box, with springs between those that overlap there. Arms sum to the branch length,
/// so a group without walls and fixed grains turns freely. kn is log-uniform over two decades. *positions, if given,
/// receives the centres.
inline Network random_network(const RandomNetworkOptions& o, std::uint64_t seed,
                              std::vector<Vec3>* positions = nullptr) {
  Random random(seed);
  Network network;
  network.dimension = o.dimension;
  network.rotation = o.rotation;
  const double edge = o.dimension == 3 ? std::cbrt(4.0 * static_cast<double>(o.grains))
                                       : std::sqrt(3.0 * static_cast<double>(o.grains));
  std::vector<Vec3> at;
  for (std::size_t i = 0; i < o.grains; ++i) {
    const double r = 0.5 * std::exp(random.uniform() * std::log(o.size_ratio));
    const double m = o.dimension == 3 ? r * r * r : r * r;
    const bool fixed = random.uniform() < o.fixed_share;
    network.radius.push_back(r);
    network.inverse_mass.push_back(fixed ? 0 : 1 / m);
    if (o.rotation) network.inverse_inertia.push_back(fixed ? 0 : 1 / ((o.dimension == 3 ? .4 : .5) * m * r * r));
    network.id.push_back(static_cast<Index>(i));
    at.push_back({random.uniform(0, edge), random.uniform(0, edge), o.dimension == 3 ? random.uniform(0, edge) : 0.0});
  }
  const auto add = [&](std::size_t i, Index j, double arm_i, double arm_j, const Vec3& n) {
    const double kn = std::pow(10, random.uniform(-1, 1));
    const double ratio = o.tangential_ratio < 0 ? random.uniform() : o.tangential_ratio;
    network.springs.push_back({static_cast<Index>(i), j, arm_i, arm_j, kn, ratio * kn, n, arm_i + arm_j});
  };
  for (std::size_t i = 0; i < o.grains; ++i) {
    for (std::size_t j = i + 1; j < o.grains; ++j) {
      const Vec3 branch = at[j] - at[i];
      const double d = norm(branch), reach = network.radius[i] + network.radius[j];
      if (d < o.crowding * reach)
        add(i, static_cast<Index>(j), d * network.radius[i] / reach, d * network.radius[j] / reach, (1 / d) * branch);
    }
    if (random.uniform() < o.wall_share) {
      Vec3 n{random.normal(), random.normal(), o.dimension == 3 ? random.normal() : 0.0};
      n *= 1 / norm(n);
      add(i, no_index, 0.98 * network.radius[i], 0, n);
    }
  }
  if (positions) *positions = at;
  return network;
}

}  // namespace eg::test
