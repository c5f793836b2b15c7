#include "specimen/make_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.hpp"
#include "contact/laws.hpp"
#include "specimen/lattice.hpp"
#include "specimen/make_walls.hpp"
#include "specimen/trim.hpp"
#include "state/friction.hpp"
#include "state/grain_mass.hpp"

namespace eg {

namespace {

void check(const Scene& scene, const Packing& packing) {
  const auto fail = [&](std::string_view subject, std::string_view rule, std::string_view remedy = {}) {
    throw input_error(scene.file, 0, subject, rule, remedy);
  };
  if (packing.size() == 0) fail("specimen", "has no grains");
  if (packing.size() >= no_index) fail("specimen", fmt::format("has more than {} grains", no_index - 1));
  if (packing.dimension != scene.dimension)
    fail(fmt::format("dimension = {}", scene.dimension), fmt::format("but the packing has {}", packing.dimension));
  if (scene.materials.empty() || !(scene.materials[0].density > 0))
    fail("density of the grains", "must be positive", "give density in [material.*]");

  const auto [low, high] = std::minmax_element(packing.radius.begin(), packing.radius.end());
  if (!(*low > 0)) fail(fmt::format("a grain of radius {:g} m", *low), "is in the packing", "radii must be positive");
  if (scene.boundary.kind == BoundarySpec::Kind::free) return;
  for (int k = 0; k < packing.dimension; ++k)
    if (packing.box[k] < 2 * *high * (1 - largest_lattice_overlap))
      fail(fmt::format("box edge {} = {:g} m", "xyz"[k], packing.box[k]),
           fmt::format("is narrower than the largest grain, {:g} m", 2 * *high), "take more grains or a larger box");
}

void check_inside(const Scene& scene, const Packing& packing) {
  for (std::size_t i = 0; i < packing.size(); ++i)
    for (int k = 0; k < packing.dimension; ++k)
      if (const double x = packing.position[i][k]; !(x >= 0 && x <= packing.box[k]))
        throw input_error(scene.file, 0, fmt::format("grain {}", i + 1),
                          fmt::format("has {} = {:g} m, outside the box [0, {:g}]", "xyz"[k], x, packing.box[k]),
                          "take boundary type \"periodic\" or \"free\", or move the grain");
}

Cell make_cell(const Scene& scene, const Packing& packing) {
  Cell cell;
  for (int k = 0; k < packing.dimension; ++k) cell.h(k, k) = packing.box[k];
  const bool periodic = scene.boundary.kind == BoundarySpec::Kind::periodic;
  cell.periodic = {periodic, periodic, periodic && packing.dimension == 3};
  return cell;
}

Grains make_grains(const Scene& scene, const Packing& packing, const Cell& cell) {
  Grains grains;
  grains.id.resize(packing.size());
  std::iota(grains.id.begin(), grains.id.end(), Index{1});
  for (std::size_t i = 0; i < packing.size(); ++i) {
    Vec3 x = packing.position[i];
    for (int k = 0; k < packing.dimension; ++k)
      if (cell.periodic[static_cast<std::size_t>(k)]) {
        x[k] -= packing.box[k] * std::floor(x[k] / packing.box[k]);
        if (x[k] >= packing.box[k]) x[k] = 0;  // round-off of a tiny negative coordinate
      }
    const double radius = packing.radius[i];
    const double mass = grain_mass(scene.dimension, scene.materials[0].density, radius).mass;
    grains.position.push_back({x.x, x.y, x.z, radius});
    grains.velocity.push_back({0, 0, 0, 1 / mass});
  }
  return grains;
}

/// Whether any contact can turn a grain: by friction, or by couples of a law that keeps more than the shear force.
bool grains_can_turn(const Scene& scene) {
  bool turn = has_friction(scene);
  with_law(scene.contact.law, [&](auto law) { turn = turn || law.history_vectors > 1 || law.history_scalars > 0; });
  return turn && scene.rotation;
}

}  // namespace

void fit_rotation(const Scene& scene, State& state) {
  auto& grains = state.grains;
  if (!grains_can_turn(scene)) {
    grains.spin.clear();
  } else if (!grains.rotates()) {
    for (std::size_t i = 0; i < grains.size(); ++i) {
      const auto [mass, inertia] = grain_mass(state.dimension, 1, grains.radius(i));
      grains.spin.push_back({0, 0, 0, grains.velocity[i].w * mass / inertia});
    }
  }
}

State make_state(const Scene& scene, const Packing& given) {
  const Packing packing = scene.specimen.trim ? trimmed(scene, given) : given;
  check(scene, packing);
  if (scene.boundary.kind == BoundarySpec::Kind::box) check_inside(scene, packing);
  State state;
  state.dimension = scene.dimension;
  state.cell = make_cell(scene, packing);
  state.grains = make_grains(scene, packing, state.cell);
  fit_rotation(scene, state);
  make_walls(scene, packing.box, state);
  state.friction = pair_friction(scene);
  state.friction_scatter = friction_scatter(scene);
  state.preparation.size = scene.specimen.first_size(scene.dimension);
  return state;
}

}  // namespace eg
