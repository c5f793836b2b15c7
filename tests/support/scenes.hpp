#pragma once
// Small scenes and states that tests share.
#include "base/random.hpp"
#include "specimen/make_packing.hpp"
#include "specimen/make_state.hpp"

namespace eg::test {

inline Material hertz_material(double g = 29e9, double nu = 0.12, double density = 2650, double friction = 0.25) {
  Material m;
  m.shear_modulus = g, m.poisson = nu, m.density = density, m.friction = friction;
  return m;
}
inline Material linear_material(double kn, double ks, double density = 2650, double friction = 0.5) {
  Material m;
  m.normal_stiffness = kn, m.shear_stiffness = ks, m.density = density, m.friction = friction;
  return m;
}

/// Quartz-like spheres with springs of the same order of stiffness: the constants of every law.
inline Material any_material() {
  Material m = hertz_material();
  m.normal_stiffness = 1e6, m.shear_stiffness = 7e5;
  m.hertz_exponent = 1.45, m.roughness = 0.2e-6;
  m.rolling_friction = 0.2;
  m.bond_modulus = 1e9, m.bond_stiffness_ratio = 2, m.bond_radius_ratio = 1, m.bond_moment_share = 0.5;
  m.bond_tensile_strength = 2e6, m.bond_shear_strength = 3e6;
  return m;
}

/// A scene whose one material has what the law needs.
inline Scene scene_of(const std::string& law, int dimension = 3) {
  Scene s;
  s.dimension = dimension;
  s.contact.law = law;
  s.materials = {any_material()};
  if (law.starts_with("linear")) s.materials[0].friction = 0.5;
  return s;
}

inline Scene lattice_scene(const std::string& law, const std::string& lattice, std::array<int, 3> cells, double overlap,
                           double radius = 1e-3) {
  Scene s = scene_of(law, lattice == "square" || lattice == "hexagonal" ? 2 : 3);
  s.specimen.source = SpecimenSpec::Source::lattice;
  s.specimen.lattice = lattice, s.specimen.cells = cells, s.specimen.overlap = overlap, s.specimen.radius = radius;
  return s;
}

inline State state_of(const Scene& scene) { return make_state(scene, make_packing(scene)); }

/// A random overlapping cluster in free space: `count` grains of radius 0.7…1.3 mm, thrown into a cube that they
/// overfill.
inline State cluster(const Scene& scene, std::size_t count, std::uint64_t seed, double fill = 1.2) {
  Random random(seed);
  Packing p;
  p.dimension = scene.dimension;
  const double edge = 2e-3 * (scene.dimension == 3 ? std::cbrt(static_cast<double>(count) / fill)
                                                   : std::sqrt(static_cast<double>(count) / fill));
  p.box = {edge, edge, scene.dimension == 3 ? edge : 1.0};
  for (std::size_t i = 0; i < count; ++i) {
    p.position.push_back(
        {random.uniform(0, edge), random.uniform(0, edge), scene.dimension == 3 ? random.uniform(0, edge) : 0.0});
    p.radius.push_back(random.uniform(0.7e-3, 1.3e-3));
  }
  Scene free = scene;
  free.boundary.kind = BoundarySpec::Kind::free;
  return make_state(free, p);
}

/// A plane at rest, a body of its own.
inline void add_plane(State& state, const Vec3& point, const Vec3& normal) {
  Wall wall;
  wall.point = point, wall.normal = normal, wall.body = static_cast<Index>(state.bodies.size());
  state.bodies.emplace_back();
  state.walls.push_back(wall);
}

}  // namespace eg::test
