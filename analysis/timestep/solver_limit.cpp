#include "timestep/solver_limit.hpp"

#include <algorithm>
#include <cmath>

#include "base/random.hpp"
#include "dynamics/engine.hpp"
#include "state/damping.hpp"

namespace eg {
namespace {

/// Root of Σ m c² + I ω² [√J]; what cannot move does not count.
double speed(const State& state) {
  double sum = 0;
  for (const auto* quads : {&state.grains.velocity, &state.grains.spin})
    for (const Quad& q : *quads)
      if (q.w > 0) sum += dot(q.vec(), q.vec()) / q.w;
  return std::sqrt(sum);
}

/// The state at rest but for a random displacement's worth of velocity, equal in energy for all degrees of freedom.
State perturbed(const State& state, const SolverLimitOptions& options) {
  State s = state;
  s.cell.rate = Mat3{};
  for (auto& b : s.bodies) b.velocity = Vec3{}, b.opening = 0;
  double smallest = INFINITY, lightest = 0;
  for (std::size_t i = 0; i < s.grains.size(); ++i) {
    smallest = std::min(smallest, s.grains.radius(i));
    lightest = std::max(lightest, s.grains.velocity[i].w);
  }
  const double size = options.perturbation * smallest / options.bracket.guess / std::sqrt(lightest);
  Random random(options.bracket.seed);
  for (auto& v : s.grains.velocity) {
    const double share = size * std::sqrt(v.w);
    v.set({share * random.normal(), share * random.normal(), s.dimension == 3 ? share * random.normal() : 0.0});
  }
  for (auto& w : s.grains.spin) {
    const double share = size * std::sqrt(w.w);
    const bool solid = s.dimension == 3;
    const double x = solid ? random.normal() : 0, y = solid ? random.normal() : 0;
    w.set(Vec3{x, y, random.normal()} * share);
  }
  return s;
}

}  // namespace

StabilityBracket solver_limit(const Scene& scene, const State& state, const SolverLimitOptions& options) {
  const State start = perturbed(state, options);
  const double first = speed(start);
  return bracket_limit(options.bracket, [&](double dt, std::int64_t& steps) {
    State s = start;
    s.dt = dt;
    Engine engine(scene, s);
    engine.set_local_damping(damping_in_force(scene, s).local);
    for (int k = 1; k <= options.steps; ++k) {
      engine.step(dt, TallyLevel::none);
      ++steps;
      if (k % 16 == 0 && !(speed(s) < options.growth * first)) return true;
    }
    return false;
  });
}

}  // namespace eg
