#pragma once
// The ugly cases: each a network (or what refuses to become one), its proved interval, and the truth.
#include <fmt/format.h>

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "../support/networks.hpp"
#include "../support/packings.hpp"
#include "assembly/stiffness.hpp"
#include "base/error.hpp"
#include "eigen/dense.hpp"
#include "timestep/interval.hpp"
#include "timestep/verify.hpp"

namespace eg::test {

struct Extreme {
  std::string name;
  std::function<Network()> make;
};

struct ExtremeRow {
  std::string name, refusal;  ///< refusal: the message, when there is no network
  std::size_t grains = 0, contacts = 0;
  StepInterval interval;
  double truth_low = 0, truth_high = 0;  ///< limit of the step [s], 0 when it was not sought
  std::string truth;                     ///< how it was found
  bool holds() const {
    return !refusal.empty() || truth.empty() ||
           (interval.dt_safe <= truth_high * (1 + 1e-12) && interval.dt_limit_upper >= truth_low * (1 - 1e-12));
  }
};

inline Network random_springs(double size_ratio, double tangential, int dimension = 3, std::size_t grains = 80) {
  RandomNetworkOptions o;
  o.dimension = dimension, o.grains = grains, o.size_ratio = size_ratio, o.tangential_ratio = tangential;
  return random_network(o, 11);
}

/// Every spring, or mass, multiplied by a random power of ten within ± decades/2.
inline Network spread(Network net, double spring_decades, double mass_decades) {
  Random random(3);
  for (auto& s : net.springs) {
    const double f = std::pow(10, spring_decades * (random.uniform() - 0.5));
    s.normal *= f, s.tangential *= f;
  }
  for (std::size_t g = 0; g < net.size(); ++g) {
    const double f = std::pow(10, mass_decades * (random.uniform() - 0.5));
    net.inverse_mass[g] *= f, net.inverse_inertia[g] *= f;
  }
  return net;
}

inline Network row_of_grains(std::size_t count, double kt) {
  Network net;
  for (std::size_t i = 0; i < count; ++i) {
    net.inverse_mass.push_back(1), net.inverse_inertia.push_back(10), net.radius.push_back(0.5);
    net.id.push_back(static_cast<Index>(i));
    const auto a = static_cast<Index>(i);
    if (i + 1 < count) net.springs.push_back({a, a + 1, .5, .5, 1, kt, {1, 0, 0}, 1});
  }
  return net;
}

/// One grain that touches `walls` planes whose normals lie on a cone (0: an edge of two planes).
inline Network grain_in_a_corner(int walls) {
  Network net = row_of_grains(1, 0);
  const int count = walls == 0 ? 2 : walls;
  for (int k = 0; k < count; ++k) {
    const double a = 6.283185307179586 * k / count;
    const Vec3 n =
        walls == 0 ? Vec3{k == 0 ? 1.0 : 0.0, k == 0 ? 0.0 : 1.0, 0} : Vec3{.6 * std::cos(a), .6 * std::sin(a), -.8};
    net.springs.push_back({0, no_index, .5, 0, 1, 0.9, n, .5});
  }
  return net;
}

/// FCC with one grain missing, or one that is lighter by `light` in mass and radius³.
inline Network flawed_crystal(double light) {
  Network net = lattice_network("fcc", 3, 1, 0.9, true);
  const Index odd = 40;
  if (light > 0) {
    net.inverse_mass[odd] *= light, net.inverse_inertia[odd] *= std::pow(light, 5.0 / 3);
    return net;
  }
  std::erase_if(net.springs, [&](const Spring& s) { return s.i == odd || s.j == odd; });
  return net;
}

inline Network pressed_lattice(double pressure) {
  Scene scene = lattice_scene("hertz-mindlin", "fcc", {3, 3, 3}, 0);
  scene.specimen.pressure = pressure;
  State state = state_of(scene);
  Engine engine(scene, state);
  return linearise(scene, state);
}

/// A cluster of grains thrown into a cube, whose overlaps reach some `overlap` of the diameter.
inline Network crushed(double overlap) {
  const Scene scene = lattice_scene("hertz-mindlin", "sc", {4, 4, 4}, 0);
  Packing packing = make_packing(scene);
  for (auto& x : packing.position) x = x * (1 - overlap);
  packing.box = packing.box * (1 - overlap);
  Random random(2);
  for (double& r : packing.radius) r *= 1 - 0.05 * random.uniform();
  State state = make_state(scene, packing);
  Engine engine(scene, state);
  return linearise(scene, state);
}

inline Network with_friction(double friction) {
  Scene scene = scene_of("hertz-mindlin");
  scene.materials[0].friction = friction;
  return linearise(scene, random_packing(scene, "uniform", 100, 1, 0.66, 300));
}

/// Pairs that touch each other and nothing else, and single grains between them.
inline Network rattlers(std::size_t count) {
  Network net = row_of_grains(count, 0.9);
  std::erase_if(net.springs, [](const Spring& s) { return s.i % 3 != 0; });
  return net;
}

/// FCC with a small grain of the same density in one of the holes between six.
inline Network interstitial() {
  const Scene scene = lattice_scene("hertz-mindlin", "fcc", {3, 3, 3}, 0.005);
  Packing packing = make_packing(scene);
  const double cell = packing.box.x / 3, radius = packing.radius.front();
  packing.position.push_back(packing.position.front() + Vec3{0.5 * cell, 0, 0});
  packing.radius.push_back(0.5 * cell - radius + 0.01 * radius);
  State state = make_state(scene, packing);
  Engine engine(scene, state);
  return linearise(scene, state);
}

inline Network isostatic(std::size_t grains) {
  Scene scene = scene_of("hertz-mindlin");
  scene.materials[0].friction = 0;
  const State state = random_packing(scene, "single", grains, 1, 0.645, 300);
  return linearise(scene, state);
}

inline Network polydisperse(std::size_t grains) {
  const Scene scene = scene_of("hertz-mindlin");
  return linearise(scene, random_packing(scene, "uniform", grains, 1, 0.66, 20));
}

/// All but the largest, which `with_large` adds.
inline std::vector<Extreme> extremes(bool with_large) {
  std::vector<Extreme> all{
      {"one grain, nothing else", [] { return row_of_grains(1, 0); }},
      {"twenty grains, no contacts",
       [] {
         auto n = row_of_grains(20, 0);
         n.springs.clear();
         return n;
       }},
      {"two grains", [] { return row_of_grains(2, 0.9); }},
      {"two frictionless grains", [] { return row_of_grains(2, 0); }},
      {"chain of 100", [] { return row_of_grains(100, 0.9); }},
      {"chain of 3000", [] { return row_of_grains(3000, 0.9); }},
      {"grain at the edge of two walls", [] { return grain_in_a_corner(0); }},
      {"grain in a cone of 12 walls", [] { return grain_in_a_corner(12); }},
      {"size ratio 1:100", [] { return random_springs(100, 0.8); }},
      {"size ratio 1:100, disks", [] { return random_springs(100, 0.8, 2); }},
      {"stiffness ratio 1e6", [] { return spread(random_springs(3, 0.8), 6, 0); }},
      {"density ratio 1e4", [] { return spread(random_springs(3, 0.8), 0, 4); }},
      {"stiffness 1e6, density 1e4, size 1:100", [] { return spread(random_springs(100, 0.8), 6, 4); }},
      {"kt/kn = 0", [] { return random_springs(3, 0); }},
      {"kt/kn = 0.01", [] { return random_springs(3, 0.01); }},
      {"kt/kn = 1", [] { return random_springs(3, 1); }},
      {"kt/kn = 10", [] { return random_springs(3, 10); }},
      {"kt/kn = 10, disks", [] { return random_springs(3, 10, 2); }},
      {"FCC at 1 Pa", [] { return pressed_lattice(1); }},
      {"FCC at 1 kPa", [] { return pressed_lattice(1e3); }},
      {"FCC at 1 MPa", [] { return pressed_lattice(1e6); }},
      {"FCC at 1 GPa", [] { return pressed_lattice(1e9); }},
      {"overlap of 30 % of the diameter", [] { return crushed(0.3); }},
      {"near-isostatic, frictionless", [] { return isostatic(200); }},
      {"friction 0", [] { return with_friction(0); }},
      {"friction 1", [] { return with_friction(1); }},
      {"friction 1e3", [] { return with_friction(1e3); }},
      {"rattlers only: pairs and single grains", [] { return rattlers(60); }},
      {"FCC with a vacancy", [] { return flawed_crystal(0); }},
      {"FCC with a small grain in a hole", [] { return interstitial(); }},
      {"FCC, one grain 100 times lighter", [] { return flawed_crystal(100); }},
      {"FCC, one grain 1e4 times lighter", [] { return flawed_crystal(1e4); }},
      {"hexagonal disks, 400", [] { return lattice_network("hexagonal", 14, 1, 1, true); }},
      {"FCC, 2,048", [] { return lattice_network("fcc", 8, 1, 0.9, true); }},
      {"random, radii 1:2, 2,000", [] { return polydisperse(2000); }},
  };
  if (with_large) all.push_back({"random, radii 1:2, 1e6", [] { return polydisperse(1000000); }});
  return all;
}

/// The interval without the dense solver, the truth with it, or by stepping where it would be long.
inline ExtremeRow work_out(const Extreme& extreme) {
  ExtremeRow row;
  row.name = extreme.name;
  Network net;
  try {
    net = extreme.make();
  } catch (const std::exception& e) {
    row.refusal = e.what();
    return row;
  }
  row.grains = net.size(), row.contacts = net.springs.size();
  row.interval = step_interval(net, {.dense_limit = 0});
  const auto dofs = net.size() * static_cast<std::size_t>(net.dofs_per_grain());
  if (net.springs.empty()) {
    row.truth = "nothing vibrates", row.truth_low = row.truth_high = INFINITY;
  } else if (dofs <= 1300) {
    const EigenResult top = dense_largest(dense_scaled_stiffness(net));
    row.truth = "dense", row.truth_low = row.truth_high = 2 / std::sqrt(top.value);
    const double margin = dense_relative_error(static_cast<int>(dofs));
    row.truth_low *= 1 - margin, row.truth_high *= 1 + margin;
  } else if (dofs <= 50000) {
    const auto b = verify_by_stepping(net, {.guess = std::sqrt(row.interval.dt_safe * row.interval.dt_limit_upper)});
    row.truth = "stepping", row.truth_low = b.stable, row.truth_high = b.unstable;
  }
  return row;
}

}  // namespace eg::test
