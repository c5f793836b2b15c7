#include "specimen/lattice.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace eg {

namespace {

const double root2 = std::sqrt(2.0), root3 = std::sqrt(3.0);

const std::vector<std::pair<std::string, LatticeCell>>& lattices() {
  static const std::vector<std::pair<std::string, LatticeCell>> all{
      {"sc", {3, 6, {1, 1, 1}, {{0.5, 0.5, 0.5}}}},
      {"bcc", {3, 8, {2 / root3, 2 / root3, 2 / root3}, {{0.25, 0.25, 0.25}, {0.75, 0.75, 0.75}}}},
      {"fcc",
       {3,
        12,
        {root2, root2, root2},
        {{0.25, 0.25, 0.25}, {0.75, 0.75, 0.25}, {0.75, 0.25, 0.75}, {0.25, 0.75, 0.75}}}},
      {"fcc-110", {3, 12, {1, 1, root2}, {{0.25, 0.25, 0.25}, {0.75, 0.75, 0.75}}}},
      {"fcc-111",
       {3,
        12,
        {1, root3, root2 * root3},
        {{0.25, 1. / 12, 1. / 6},
         {0.75, 7. / 12, 1. / 6},
         {0.75, 3. / 12, 3. / 6},
         {0.25, 9. / 12, 3. / 6},
         {0.25, 5. / 12, 5. / 6},
         {0.75, 11. / 12, 5. / 6}}}},
      {"hcp",
       {3,
        12,
        {1, root3, 2 * root2 / root3},
        {{0.25, 1. / 12, 0.25}, {0.75, 7. / 12, 0.25}, {0.25, 5. / 12, 0.75}, {0.75, 11. / 12, 0.75}}}},
      {"square", {2, 4, {1, 1, 0}, {{0.5, 0.5, 0}}}},
      {"hexagonal", {2, 6, {1, root3, 0}, {{0.25, 0.25, 0}, {0.75, 0.75, 0}}}},
  };
  return all;
}

std::vector<double> scattered_radii(std::size_t count, double mean, double scatter, Random& random) {
  std::vector<double> radii(count, mean);
  if (scatter == 0) return radii;
  for (double& radius : radii) {
    double deviation = random.normal();
    while (std::abs(deviation) > 3) deviation = random.normal();
    radius = mean * (1 + scatter * deviation);
  }
  return radii;
}

/// Moves the box onto the outermost grains.
void fit_box(Packing& packing) {
  for (int k = 0; k < packing.dimension; ++k) {
    double low = packing.position[0][k], high = low;
    for (std::size_t i = 0; i < packing.size(); ++i) {
      low = std::min(low, packing.position[i][k] - packing.radius[i]);
      high = std::max(high, packing.position[i][k] + packing.radius[i]);
    }
    for (auto& x : packing.position) x[k] -= low;
    packing.box[k] = high - low;
  }
}

}  // namespace

double LatticeCell::volume_per_grain() const {
  return edges.x * edges.y * (dimension == 3 ? edges.z : 1.0) / static_cast<double>(sites.size());
}

std::optional<LatticeCell> find_lattice(std::string_view name) {
  for (const auto& [known, cell] : lattices())
    if (known == name) return cell;
  return {};
}

std::vector<std::string> lattice_names() {
  std::vector<std::string> names;
  for (const auto& entry : lattices()) names.push_back(entry.first);
  return names;
}

double lattice_pressure(const LatticeCell& cell, double radius, double relative_overlap, const NormalForce& force) {
  const double spacing = 2 * radius * (1 - relative_overlap);
  const double share =
      cell.volume_per_grain() * (cell.dimension == 3 ? spacing * spacing * spacing : spacing * spacing);
  return cell.coordination * force(radius, 2 * radius * relative_overlap) * spacing / (2 * cell.dimension * share);
}

std::optional<double> lattice_overlap(const LatticeCell& cell, double radius, double pressure,
                                      const NormalForce& force) {
  double low = 0, high = largest_lattice_overlap;
  if (lattice_pressure(cell, radius, high, force) < pressure) return {};
  for (double middle = high / 2; low < middle && middle < high; middle = low + (high - low) / 2)
    (lattice_pressure(cell, radius, middle, force) < pressure ? low : high) = middle;
  return high;
}

Packing make_lattice(const LatticeCell& cell, const LatticeSize& size, Random& random) {
  assert(size.radius > 0 && size.relative_overlap <= largest_lattice_overlap);
  assert(size.radius_scatter >= 0 && 3 * size.radius_scatter < 1);
  const auto [nx, ny, nz_given] = size.cells;
  const int nz = cell.dimension == 3 ? nz_given : 1;
  assert(nx > 0 && ny > 0 && nz > 0);

  Packing packing;
  packing.dimension = cell.dimension;
  packing.radius = scattered_radii(
      cell.sites.size() * static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny) * static_cast<std::size_t>(nz),
      size.radius, size.radius_scatter, random);
  const double spacing =
      2 * *std::max_element(packing.radius.begin(), packing.radius.end()) * (1 - size.relative_overlap);
  const Vec3 edges = cell.edges * spacing;
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i)
        for (const Vec3& site : cell.sites)
          packing.position.push_back({edges.x * (i + site.x), edges.y * (j + site.y), edges.z * (k + site.z)});

  packing.box = {edges.x * nx, edges.y * ny, cell.dimension == 3 ? edges.z * nz : 1.0};
  packing.periodic = {size.periodic, size.periodic, size.periodic && cell.dimension == 3};
  if (!size.periodic) fit_box(packing);
  return packing;
}

}  // namespace eg
