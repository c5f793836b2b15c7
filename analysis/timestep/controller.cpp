#include "timestep/controller.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include "assembly/linearise.hpp"
#include "base/error.hpp"
#include "state/damping.hpp"
#include "timestep/damped_interval.hpp"
#include "timestep/estimates.hpp"
#include "timestep/splitting.hpp"

namespace eg {
namespace {

constexpr std::uint64_t nearest = 4, furthest = 512;     // steps from one check to the next …
constexpr std::uint64_t in_flow = 192;                   // … and where forecasts cost too much of the step
constexpr std::uint64_t youngest = 1000, oldest = 5000;  // steps that a bound may live
constexpr double slack = 0.05;                           // of an overlap: 2.5 % of the stiffness of a Hertz contact
constexpr double least_room = 0.04, most_room = 0.44;
constexpr double loose = 0.75;  // step over limit, below which forecasts are taken to cost too much
constexpr double gain = 1.04;   // of the step, from which on a renewal was worth its cost

/// Steps to the next check.
std::uint64_t look_ahead(const State& state) { return std::clamp(state.policy.ahead, nearest, furthest); }

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

}  // namespace

std::string step_cause_name(StepCause cause) {
  static constexpr std::array<const char*, step_causes> names{"start", "stage", "growth", "renewal", "rebuild"};
  return names[static_cast<std::size_t>(cause)];
}

std::uint64_t ControllerLog::all_evaluations() const {
  return std::accumulate(evaluations.begin(), evaluations.end(), std::uint64_t{0});
}

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

void Controller::choose(State& state) {
  auto& plan = state.policy;
  const auto& spec = scene_.timestep;
  if (spec.policy == "certified")
    plan.dt = spec.safety * plan.safe;
  else if (spec.policy == "fixed")
    plan.dt = spec.fixed;
  else
    plan.dt = std::min(spec.safety * estimated_step(scene_, linearise(scene_, state),
                                                    spec.policy.substr(std::string("estimate:").size())),
                       free_limit(state));
}

void Controller::evaluate(State& state, const Schedule& schedule, StepCause cause) {
  auto& plan = state.policy;
  const std::uint64_t age = state.step - plan.made;
  if (plan.lifetime == 0) plan.lifetime = youngest, plan.room = 2 * least_room;
  if (cause == StepCause::growth && age < 2 * youngest) plan.room = std::min(most_room, plan.room * 1.5);
  if (cause == StepCause::renewal && age >= 2 * youngest) plan.room = std::max(least_room, plan.room / 1.25);

  const double cap = free_limit(state), before = plan.safe;
  const double dt = plan.dt > 0 ? plan.dt : scene_.timestep.safety * cap;
  // what a failed check has looked at serves until it was for
  const bool checked = cause == StepCause::growth && !damping_in_force(scene_, state).dashpots();
  const double time = static_cast<double>(checked ? plan.check - state.step : look_ahead(state)) * dt;
  const DampingSpec damping = damping_in_force(scene_, state);
  double lower = 0;
  const auto renew = [&](double step) {
    // most of the room goes to what all contacts (of Hertz) may grow by together, the rest to single ones
    const double growth = 1 + 0.3 * plan.room;
    lower =
        bounds_.renew(state, schedule, {time, growth * growth - 1, 0.4 * plan.room, 4 / (cap * cap), step, !checked});
    plan.safe = std::min(cap, proved_damped_step(plan.bound.value, damping, step));
  };
  renew(before > 0 ? before : cap);
  if (damping.dashpots() && std::abs(plan.safe - plan.bound.step) > 0.02 * plan.safe) renew(plan.safe);
  plan.unsafe = refuted_damped_step(lower, damping, plan.bound.step);
  if (before > 0) {
    log_.worst_true = std::max(log_.worst_true, plan.dt / plan.unsafe);
    if (plan.unsafe < before) ++log_.outruns;
    if (before < loose * plan.unsafe && plan.ahead > in_flow) plan.ahead = in_flow;
  }
  choose(state);

  if (cause == StepCause::renewal)
    plan.lifetime =
        plan.safe > gain * before ? std::max(youngest, plan.lifetime / 2) : std::min(oldest, plan.lifetime * 2);
  plan.cause = static_cast<int>(cause);
  plan.made = state.step;
  plan.due = state.step + plan.lifetime;
  plan.check =
      state.step + static_cast<std::uint64_t>(std::clamp(time / plan.dt, 1.0, static_cast<double>(look_ahead(state))));
  plan.refreshes = state.list.refreshes;
  log_.worst_ratio = std::max(log_.worst_ratio, plan.dt / plan.safe);
  ++log_.evaluations[static_cast<std::size_t>(cause)];
  if (on_change) on_change(state);
}

bool Controller::still_stands(State& state, const Schedule& schedule) {
  auto& plan = state.policy;
  ++log_.checks;
  const auto ahead = [&] { return static_cast<double>(plan.check - state.step) * plan.dt; };
  if (state.step < plan.check && bounds_.check_fresh(state, ahead(), slack)) return true;
  plan.check = state.step + look_ahead(state);
  const auto result = bounds_.check(state, schedule, ahead(), slack);
  log_.mended += result.mended;
  // A stage that begins may set everything in motion at once, and so may collisions.
  plan.ahead = look_ahead(state);
  plan.ahead = result.outrun ? plan.ahead / 2 : plan.ahead + plan.ahead / (plan.ahead < in_flow ? 4 : 8);
  return result.stands;
}

double Controller::next_step(State& state, const Schedule& schedule) {
  auto& plan = state.policy;
  const bool refreshed = plan.refreshes != state.list.refreshes;
  if (plan.dt > 0 && !refreshed && state.step < plan.check && state.step < plan.due) return plan.dt;

  const auto begin = std::chrono::steady_clock::now();
  if (plan.dt == 0)
    evaluate(state, schedule, state.step == 0 ? StepCause::start : StepCause::stage);
  else if (refreshed && !bounds_.follow(state))
    evaluate(state, schedule, StepCause::rebuild);
  else if (state.step >= plan.due)
    evaluate(state, schedule, StepCause::renewal);
  else if (plan.refreshes = state.list.refreshes; !still_stands(state, schedule))
    evaluate(state, schedule, StepCause::growth);
  log_.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return plan.dt;
}

}  // namespace eg
