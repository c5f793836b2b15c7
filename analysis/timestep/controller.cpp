#include "timestep/controller.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "assembly/linearise.hpp"
#include "base/error.hpp"
#include "state/damping.hpp"
#include "timestep/damped_interval.hpp"
#include "timestep/estimates.hpp"
#include "timestep/scalar_weights.hpp"

namespace eg {
namespace {

constexpr std::uint64_t shortest = 20, longest = 1000;  // steps of a horizon
constexpr double calm = 1.03, wild = 1.12;              // growth of λ over the horizon: lengthen below, shorten above
constexpr double closing_margin = 1.5;                  // forecast over present closing speed

/// How much the overlap of a pair can grow in `time`, from its present closing speed.
OverlapGrowth closing(const State& state, double time) {
  return [&state, time](Index i, Index j, const Geometry<double>& g) {
    const auto& grains = state.grains;
    Vec3 relative = -grains.velocity[i].vec();
    if (j == no_index) {
      double wall = 0;
      for (const auto& w : state.walls) wall = std::max(wall, norm(w.velocity));
      return closing_margin * time * (std::max(0.0, -dot(relative, g.n)) + wall);
    }
    const double distance = grains.radius(i) + grains.radius(j) - g.overlap;
    relative += grains.velocity[j].vec() + state.cell.rate * (g.n * distance);
    return closing_margin * time * std::max(0.0, -dot(relative, g.n));
  };
}

/// The safety factor times the named rule.
double estimated_step(const Scene& scene, const Network& net, const std::string& name) {
  const Material& m = scene.materials.front();
  const auto known = [](double x) { return std::isnan(x) ? std::nullopt : std::optional<double>(x); };
  const auto rows =
      time_step_estimates(net, {known(m.shear_modulus), known(m.poisson), known(m.density), std::nullopt});
  std::vector<std::string> names;
  for (const auto& row : rows) {
    if (row.name == name) return row.dt;
    names.push_back(row.name);
  }
  if (rows.empty()) return INFINITY;
  throw InputError(
      fmt::format("{}: timestep.policy = \"estimate:{}\" is not a rule that this scene allows; known here: {}",
                  scene.file, name, fmt::join(names, ", ")));
}

/// As λmax is now, seen from below; what it is held against must be seen from below too.
double present_self_block(const Scene& scene, const State& state) {
  const Network net = linearise(scene, state);
  return largest_self_block(Sides(net));
}

}  // namespace

double Controller::free_limit(const State& state) const {
  const auto lightest = std::max_element(state.grains.velocity.begin(), state.grains.velocity.end(),
                                         [](const Quad& a, const Quad& b) { return a.w < b.w; });
  if (lightest == state.grains.velocity.end() || !(lightest->w > 0)) return INFINITY;
  const auto i = static_cast<std::size_t>(lightest - state.grains.velocity.begin());
  const double r = state.grains.radius(i);
  State pair = State{};  // the lightest grain and its twin
  pair.dimension = state.dimension;
  pair.grains.position = {{0, 0, 0, r}, {2 * r * (1 - 0.5e-6), 0, 0, r}};
  pair.grains.velocity = {{0, 0, 0, lightest->w}, {0, 0, 0, lightest->w}};
  if (state.grains.rotates()) pair.grains.spin = {{0, 0, 0, state.grains.spin[i].w}, {0, 0, 0, state.grains.spin[i].w}};
  pair.grains.id = {1, 2};
  pair.contacts.i = {0}, pair.contacts.j = {1};
  pair.contacts.history_size = state.contacts.history_size,
  pair.contacts.history_vectors = state.contacts.history_vectors;
  pair.contacts.history.assign(Contacts::lanes * pair.contacts.history_size, 0.0);
  const Network net = linearise(scene_, pair);
  return damped_safe_step(net, damping_in_force(scene_, state), 0, [](Network twelve) {
    for (auto& s : twelve.springs) s.normal *= 12, s.tangential *= 12;
    return splitting_bound(twelve).value;
  });
}

void Controller::evaluate(State& state) {
  const auto begin = std::chrono::steady_clock::now();
  auto& plan = state.policy;
  if (plan.horizon == 0) plan.horizon = shortest;
  const double dt = plan.dt > 0 ? plan.dt : state.dt > 0 ? state.dt : 0.0;
  const Network net = linearise(scene_, state, closing(state, static_cast<double>(plan.horizon) * dt));
  const double cap = free_limit(state);
  const Sides sides(net);
  const auto bound = [](const Network& n) {
    return splitting_bound(n, {.scalar_sweeps = 8, .matrix_sweeps = 0}).value;
  };
  plan.safe = std::min(cap, damped_safe_step(net, damping_in_force(scene_, state), plan.safe, bound));
  const auto& spec = scene_.timestep;
  if (spec.policy == "certified")
    plan.dt = spec.safety * plan.safe;
  else if (spec.policy == "fixed")
    plan.dt = spec.fixed;
  else
    plan.dt =
        std::min(spec.safety * estimated_step(scene_, net, spec.policy.substr(std::string("estimate:").size())), cap);

  plan.due = state.step + plan.horizon;
  const double growth = plan.safe < cap ? largest_self_block(sides) / present_self_block(scene_, state) : 1.0;
  if (growth > wild) plan.horizon = std::max(shortest, plan.horizon / 2);
  if (growth < calm) plan.horizon = std::min(longest, plan.horizon * 3 / 2);
  log_.worst_ratio = std::max(log_.worst_ratio, plan.dt / plan.safe);
  ++log_.evaluations;
  log_.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

double Controller::next_step(State& state) {
  if (state.policy.dt == 0 || state.step >= state.policy.due) evaluate(state);
  return state.policy.dt;
}

}  // namespace eg
