#pragma once
// Packings under load for benchmarks and tests, made in a few hundred steps: swollen clouds and lattices at rest.
#include <string>

#include "assembly/linearise.hpp"
#include "dynamics/engine.hpp"
#include "specimen/cloud.hpp"
#include "support/scenes.hpp"
#include "timestep/splitting.hpp"

namespace eg::test {

/// Damped steps at half the proved limit, renewed every 50 steps.
inline void relax(const Scene& scene, State& state, int steps) {
  Engine engine(scene, state);
  engine.set_local_damping(0.7);
  double dt = 0;
  for (int k = 0; k < steps; ++k) {
    if (k % 50 == 0) dt = 1 / std::sqrt(splitting_bound(linearise(scene, state), {.matrix_sweeps = 0}).value);
    engine.step(dt);
  }
}

/// "single" (equal radii), "uniform" (radii 1:2), "wide" (1:5), "gap" (1:4, nothing between; a twentieth of the number
/// is large).
inline std::vector<double> radii_of(const std::string& grading, std::size_t count, Random& random) {
  std::vector<double> radii;
  for (std::size_t k = 0; k < count; ++k) {
    const double u = random.uniform();
    double r = 1;
    if (grading == "uniform") r = 1 + u;
    if (grading == "wide") r = 1 / std::sqrt(1 - u * 0.96);  // number density ~ r^-3
    if (grading == "gap") r = u < 0.05 ? 4 : 1;
    radii.push_back(1e-3 * r);
  }
  return radii;
}

/// A random packing at rest: a cloud swollen to `fraction` and relaxed. Hertz–Mindlin quartz in a periodic cell.
inline State random_packing(const Scene& scene, const std::string& grading, std::size_t count, std::uint64_t seed = 1,
                            double fraction = 0.66, int steps = 200) {
  Random random(seed);
  const auto radii = radii_of(grading, count, random);
  const double loose = scene.dimension == 3 ? 0.5 : 0.7;
  Packing packing = make_cloud(radii, {scene.dimension, loose}, random);
  const double shrink = std::pow(loose / fraction, 1.0 / scene.dimension);
  for (auto& x : packing.position) x = x * shrink;
  packing.box = packing.box * shrink;
  if (scene.dimension == 2) packing.box.z /= shrink;
  State state = make_state(scene, packing);
  relax(scene, state, steps);
  return state;
}

/// A lattice pressed to an overlap of 1 % of the diameter, its radii then scattered (normal, standard deviation over
/// mean), and relaxed.
inline State scattered_lattice(const Scene& scene, double scatter, std::uint64_t seed = 1) {
  Random random(seed);
  Packing packing = make_packing(scene);
  for (double& r : packing.radius) r *= 1 + scatter * random.normal();
  State state = make_state(scene, packing);
  relax(scene, state, 300);
  return state;
}

}  // namespace eg::test
