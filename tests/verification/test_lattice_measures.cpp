// A lattice made for a pressure, seen by neighbour search, contact law and measures: all must agree.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "measure/homogenised.hpp"
#include "measure/stress.hpp"
#include "search/neighbours.hpp"
#include "specimen/lattice.hpp"
#include "specimen/make_packing.hpp"
#include "specimen/make_state.hpp"

using namespace eg;

namespace {

Scene lattice_scene(const std::string& name, const std::string& law) {
  Scene scene;
  scene.dimension = find_lattice(name)->dimension;
  Material m;
  m.density = 2650, m.friction = 0.25, m.shear_modulus = 29e9, m.poisson = 0.12;
  m.normal_stiffness = 1e8, m.shear_stiffness = 5e7;
  scene.materials = {m};
  scene.contact.law = law;
  scene.specimen.source = SpecimenSpec::Source::lattice;
  scene.specimen.lattice = name;
  scene.specimen.cells = {3, 4, 3};
  scene.specimen.radius = 1e-3;
  return scene;
}

State listed(const Scene& scene) {
  State state = make_state(scene, make_packing(scene));
  rebuild_neighbours(state, 1e-4, 1e-5);
  return state;
}

}  // namespace

TEST(LatticeMeasures, PressureCoordinationFabricVolume) {
  for (const auto& name : lattice_names())
    for (const std::string law : {"hertz-mindlin", "linear"}) {
      SCOPED_TRACE(name + " " + law);
      Scene scene = lattice_scene(name, law);
      scene.specimen.pressure = scene.dimension == 3 ? 1e6 : 1e4;
      const State state = listed(scene);
      const auto cell = *find_lattice(name);
      const Homogenised h = homogenise(scene, state);
      for (int i = 0; i < scene.dimension; ++i)
        for (int j = 0; j < scene.dimension; ++j) {
          EXPECT_NEAR(h.stress(i, j) / scene.specimen.pressure, i == j, 1e-9);
          EXPECT_NEAR(h.fabric(i, j), i == j ? 1. / scene.dimension : 0, 1e-12);
        }
      EXPECT_NEAR(h.mean_stress / scene.specimen.pressure, 1, 1e-9);
      EXPECT_EQ(h.coordination.mean, cell.coordination);
      EXPECT_EQ(h.coordination.mechanical, cell.coordination);
      EXPECT_EQ(h.backbone.grains, state.grains.size());
      EXPECT_LT(h.unbalanced_force, 1e-9);
      EXPECT_EQ(h.kinetic_energy, 0);
      EXPECT_EQ(h.sliding_fraction, 0);
      const double distance = 2e-3 * (1 - h.largest_overlap);
      const double share = cell.volume_per_grain() * std::pow(distance, scene.dimension);
      EXPECT_NEAR(h.volume / (share * static_cast<double>(state.grains.size())), 1, 1e-12);
      const double lens = cell.coordination / 2. * lens_volume(scene.dimension, 1e-3, 1e-3, distance);
      const double solid = grain_volume(scene.dimension, 1e-3);
      EXPECT_NEAR(h.void_ratio, share / solid - 1, 1e-11);
      EXPECT_NEAR(h.void_ratio_corrected, share / (solid - lens) - 1, 1e-11);
      EXPECT_GT(h.void_ratio_corrected, h.void_ratio);
    }
}

TEST(LatticeMeasures, StressIsTheSlopeOfTheElasticEnergy) {  // p = −dW/dV
  for (const auto& name : lattice_names()) {
    SCOPED_TRACE(name);
    Scene scene = lattice_scene(name, "hertz-mindlin");
    const auto at = [&](double overlap) {
      scene.specimen.overlap = overlap;
      return homogenise(scene, listed(scene));
    };
    const auto low = at(1e-3 - 1e-6), middle = at(1e-3), high = at(1e-3 + 1e-6);
    const double slope = (high.elastic_energy - low.elastic_energy) / (low.volume - high.volume);
    EXPECT_NEAR(slope / middle.mean_stress, 1, 1e-5);
  }
}

TEST(LatticeMeasures, WallsCarryTheStress) {  // in equilibrium, traction on a face is the wall's force over its area
  Scene scene = lattice_scene("sc", "linear");
  scene.boundary.kind = BoundarySpec::Kind::box;
  scene.boundary.bodies = box_bodies(scene.dimension);
  scene.boundary.wall_material = "grain";
  scene.specimen.overlap = 2e-3;
  State state = make_state(scene, make_packing(scene));
  for (auto& wall : state.walls) wall.point = wall.point + 4e-6 * wall.normal;  // the overlap of two grains
  rebuild_neighbours(state, 1e-4, 1e-5);
  const auto contacts = touching_contacts(scene, state);
  Vec3 pushed;  // on the upper walls
  for (const auto& c : contacts)
    if (c.j == no_index && c.wall % 2 == 1) pushed += c.force();
  EXPECT_EQ(coordination(36, contacts).wall_contacts, 2u * (9 + 12 + 12));
  EXPECT_LT(unbalanced_force(state, contacts, {}), 1e-9);
  const double volume = specimen_volume(state);
  const Mat3 sigma = stress(contacts, volume);
  for (int k = 0; k < 3; ++k) {
    const auto upper = static_cast<std::size_t>(2 * k + 1);
    const double length = state.walls[upper].point[k] - state.walls[upper - 1].point[k];
    EXPECT_NEAR(sigma(k, k) / (pushed[k] * length / volume), 1, 1e-9);
    EXPECT_NEAR(sigma(k, (k + 1) % 3), 0, 1e-9 * sigma(k, k));
  }
}
