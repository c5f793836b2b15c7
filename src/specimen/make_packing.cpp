#include "specimen/make_packing.hpp"

#include <fmt/format.h>

#include <cassert>
#include <cmath>

#include "base/error.hpp"
#include "base/random.hpp"
#include "contact/laws.hpp"
#include "specimen/cloud.hpp"
#include "specimen/grading.hpp"
#include "specimen/lattice.hpp"

namespace eg {

NormalForce normal_force(const Scene& scene) {
  NormalForce force;
  with_law(scene.contact.law, [&](auto law) {
    using Law = decltype(law);
    const auto constants = Law::constants(scene.materials.at(0), scene.materials.at(0), scene.dimension);
    force = [constants](double radius, double overlap) {
      return Law::template normal<double>(Law::template pair<double>(constants, grain_sizes(radius, radius)), overlap)
          .force;
    };
  });
  if (!force)
    throw input_error(scene.file, 0, fmt::format("contact.law = \"{}\"", scene.contact.law), "is not a contact law");
  return force;
}

namespace {

double overlap_of(const Scene& scene, const LatticeCell& cell) {
  const auto& spec = scene.specimen;
  if (std::isnan(spec.pressure)) {
    if (spec.overlap > largest_lattice_overlap)
      throw input_error(scene.file, 0, fmt::format("specimen.overlap = {:g}", spec.overlap),
                        fmt::format("must not be more than {:g} of the diameter", largest_lattice_overlap));
    return spec.overlap;
  }
  if (spec.radius_scatter > 0)
    throw input_error(scene.file, 0, "specimen.pressure", "is not defined for a lattice with radius_scatter",
                      "give specimen.overlap and compress the lattice in a stage");
  if (spec.pressure == 0) return 0;
  const auto overlap = lattice_overlap(cell, spec.radius, spec.pressure, normal_force(scene));
  if (!overlap)
    throw input_error(scene.file, 0, fmt::format("specimen.pressure = {:g}", spec.pressure),
                      fmt::format("needs overlaps of more than {:g} of the diameter", largest_lattice_overlap),
                      "lower the pressure or give a stiffer material");
  return *overlap;
}

Packing lattice_packing(const Scene& scene, Random& random) {
  const auto& spec = scene.specimen;
  const auto cell = find_lattice(spec.lattice);
  if (!cell || cell->dimension != scene.dimension)
    throw input_error(scene.file, 0, fmt::format("specimen.lattice = \"{}\"", spec.lattice),
                      fmt::format("is not a lattice in {} dimensions", scene.dimension),
                      scene.dimension == 3 ? "take sc, bcc, fcc, fcc-110, fcc-111 or hcp" : "take square or hexagonal");
  return make_lattice(*cell,
                      {.cells = spec.cells,
                       .radius = spec.radius,
                       .relative_overlap = overlap_of(scene, *cell),
                       .radius_scatter = spec.radius_scatter,
                       .periodic = scene.boundary.kind == BoundarySpec::Kind::periodic},
                      random);
}

Packing cloud_packing(const Scene& scene, Random& random) {
  const auto& spec = scene.specimen;
  const std::size_t count =
      spec.coarse_count > 0 ? count_with_coarse(spec.grading, scene.dimension, spec.coarse_count) : spec.count;
  if (count == 0) throw input_error(scene.file, 0, "specimen.count = 0", "must be at least 1");
  auto radii = draw_radii(spec.grading, scene.dimension, count, random);
  for (double& r : radii) r *= spec.first_size(scene.dimension);
  return make_cloud(radii,
                    {.dimension = scene.dimension,
                     .solid_fraction = spec.solid_fraction,
                     .aspect = spec.aspect,
                     .periodic = scene.boundary.kind == BoundarySpec::Kind::periodic,
                     .box = spec.box},
                    random);
}

}  // namespace

Packing make_packing(const Scene& scene) {
  assert(scene.specimen.source != SpecimenSpec::Source::file);
  Random random(scene.seed);
  return scene.specimen.source == SpecimenSpec::Source::lattice ? lattice_packing(scene, random)
                                                                : cloud_packing(scene, random);
}

}  // namespace eg
