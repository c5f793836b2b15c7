#include "measure/displacement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "base/error.hpp"
#include "measure/gradient_fit.hpp"
#include "measure/images.hpp"
#include "measure/point_grid.hpp"
#include "measure/tensor.hpp"

namespace eg {

namespace {

/// Edges of the later cell, renamed by their lattice to those nearest to the deformed earlier ones (Cell::straighten()
/// may have renamed them in between); directions that are not periodic keep the earlier edge.
Mat3 matching_edges(const Cell& before, const Cell& now) {
  Mat3 h = now.h;
  for (int k = 0; k < 3; ++k)
    if (!now.periodic[static_cast<std::size_t>(k)])
      for (int i = 0; i < 3; ++i) h(i, k) = before.h(i, k);
  for (int k = 1; k < 3; ++k)
    for (int i = k - 1; i >= 0; --i) {
      if (!now.periodic[static_cast<std::size_t>(i)]) continue;
      const double expected = before.h(i, k) * h(i, i) / before.h(i, i);
      const double steps = std::round((expected - h(i, k)) / h(i, i));
      for (int row = 0; row <= i; ++row) h(row, k) += steps * h(row, i);
    }
  return h;
}

/// `d` without whole edges along periodic directions.
Vec3 wrapped(const Cell& cell, const Mat3& edges, Vec3 d) {
  Vec3 steps = inverse(edges) * d;
  for (int k = 0; k < 3; ++k) steps[k] = cell.periodic[static_cast<std::size_t>(k)] ? std::round(steps[k]) : 0;
  return d - edges * steps;
}

/// Places and displacements of all grains and of those images that lie within `reach` of the cell.
struct Field {
  std::vector<Vec3> place, displacement;
};

Field with_images(const Displacements& motion, double reach) {
  Field field{motion.from, motion.displacement};
  const Cell& cell = motion.cell;
  if (!cell.any_periodic()) return field;
  const Vec3 diagonal = cell.h * Vec3{1, 1, 1}, centre = cell.origin + 0.5 * diagonal;
  double around = reach;
  for (int k = 0; k < 3; ++k) around += norm(cell.h * Vec3{double(k == 0), double(k == 1), double(k == 2)});
  for (std::size_t i = 0; i < motion.size(); ++i)
    visit_images(cell, motion.from[i], centre, around, [&](const Vec3& shift) {
      const Vec3 x = motion.from[i] + shift, f = cell.fractional(x);
      if (dot(shift, shift) == 0) return;
      for (int k = 0; k < 3; ++k) {
        const double margin = reach / cell.width(k);
        if (cell.periodic[static_cast<std::size_t>(k)] && (f[k] < -margin || f[k] > 1 + margin)) return;
      }
      field.place.push_back(x), field.displacement.push_back(motion.displacement[i] + motion.gradient * shift);
    });
  return field;
}

}  // namespace

Displacements displacements_between(const State& before, const State& now) {
  if (before.dimension != now.dimension)
    throw InputError(fmt::format("--since: a {}D state before a {}D one", before.dimension, now.dimension));
  Displacements motion;
  motion.dimension = now.dimension, motion.cell = before.cell;
  std::unordered_map<Index, std::size_t> place;
  for (std::size_t i = 0; i < before.grains.size(); ++i) place[before.grains.id[i]] = i;
  const Mat3 edges = matching_edges(before.cell, now.cell), map = edges * inverse(before.cell.h);
  if (now.cell.any_periodic()) motion.gradient = map - Mat3::identity();
  for (std::size_t k = 0; k < now.grains.size(); ++k) {
    const auto found = place.find(now.grains.id[k]);
    if (found == place.end()) continue;
    const Vec3 half = before.cell.h * Vec3{0.5, 0.5, 0.5}, centre = before.cell.origin + half;
    const Vec3 from =
        centre + wrapped(before.cell, before.cell.h, before.grains.position[found->second].vec() - centre);
    const Vec3 expected = now.cell.origin + map * (from - before.cell.origin);
    const Vec3 to = expected + wrapped(now.cell, edges, now.grains.position[k].vec() - expected);
    motion.now.push_back(k);
    motion.radius.push_back(now.grains.radius(k));
    motion.from.push_back(from), motion.displacement.push_back(to - from);
  }
  if (motion.size() == 0) throw InputError("--since: the two snapshots have no grain in common; take two of one run");
  return motion;
}

SmallStrain strain_of(const Mat3& g, int dimension) {
  SmallStrain strain;
  strain.tensor = -0.5 * (g + transpose(g));
  const auto values = principal(strain.tensor, dimension).values;
  strain.volumetric = trace(strain.tensor);
  strain.shear = values[0] - values[dimension == 3 ? 2 : 1];
  strain.rotation = 0.5 * Vec3{g(2, 1) - g(1, 2), g(0, 2) - g(2, 0), g(1, 0) - g(0, 1)};
  return strain;
}

std::vector<Mat3> local_gradients(const Displacements& motion, double reach) {
  const Field field = with_images(motion, reach);
  const PointGrid grid(field.place, reach);
  std::vector<Mat3> gradients(motion.size());
#pragma omp parallel for schedule(dynamic, 64)
  for (std::size_t i = 0; i < motion.size(); ++i) {
    std::vector<Sample> samples;
    grid.near(motion.from[i], reach, [&](std::size_t j) {
      const Vec3 d = field.place[j] - motion.from[i];
      const double rest = 1 - dot(d, d) / (reach * reach);
      samples.push_back({field.place[j], field.displacement[j], rest * rest});
    });
    const auto fit = fit_gradient(samples, motion.dimension);
    gradients[i] = fit ? *fit : std::numeric_limits<double>::quiet_NaN() * Mat3::identity();
  }
  return gradients;
}

std::size_t nearest_grain(const Displacements& motion, const Vec3& place) {
  std::size_t best = 0;
  double least = INFINITY;
  for (std::size_t i = 0; i < motion.size(); ++i)
    if (const double d = norm(wrapped(motion.cell, motion.cell.h, motion.from[i] - place)); d < least)
      least = d, best = i;
  return best;
}

SphereDisplacement displacement_inside(const Displacements& motion, const MeasureSphere& sphere) {
  SphereDisplacement result;
  std::vector<Sample> inside;
  for (std::size_t i = 0; i < motion.size(); ++i)
    visit_images(motion.cell, motion.from[i], sphere.centre, sphere.radius, [&](const Vec3& shift) {
      if (norm(motion.from[i] + shift - sphere.centre) > sphere.radius) return;
      inside.push_back({motion.from[i] + shift, motion.displacement[i] + motion.gradient * shift});
    });
  for (const auto& s : inside) result.displacement += (1 / static_cast<double>(inside.size())) * s.value;
  result.grains = inside.size();
  result.gradient = fit_gradient(inside, motion.dimension);
  return result;
}

}  // namespace eg
