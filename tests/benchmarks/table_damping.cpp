// The step at which the solver blows up, measured, against the step computed from the matrices: damped states, and
// states whose contacts slide. Run by: ./dev bench damping [--json]
#include <fmt/format.h>

#include "report/table.hpp"
#include "support/packings.hpp"
#include "support/program.hpp"
#include "timestep/consistent.hpp"
#include "timestep/damped_interval.hpp"
#include "timestep/solver_limit.hpp"

using namespace eg;

namespace {

struct Case {
  std::string name;
  DampingSpec damping;
};

std::vector<Case> damping_cases(double omega) {
  std::vector<Case> cases{{"none", {}}};
  for (const double alpha : {0.1, 0.4, 0.7}) {
    cases.push_back({fmt::format("local {}", alpha), {}});
    cases.back().damping.local = alpha;
  }
  for (const double ratio : {0.05, 0.2, 0.5, 1.0, 2.0}) {
    cases.push_back({fmt::format("dashpots {}", ratio), {}});
    cases.back().damping.normal_ratio = cases.back().damping.shear_ratio = ratio;
  }
  for (const double share : {0.01, 0.1, 1.0}) {
    cases.push_back({fmt::format("mass {} ω", share), {}});
    cases.back().damping.mass = share * omega;
  }
  cases.push_back({"local 0.3, dashpots 0.3", {}});
  auto& all = cases.back().damping;
  all.local = all.normal_ratio = all.shear_ratio = 0.3;
  return cases;
}

/// A row: everything over the undamped limit dt0.
void add_row(Table& table, const std::string& packing, const Case& c, Scene scene, const State& state, double dt0) {
  scene.damping = c.damping;
  const Network net = linearise(scene, state);
  const auto v = damped_interval(net, c.damping, step_interval(net));
  const auto consistent = consistent_report(scene, state, net, {.dense_limit = 0, .wanted = 2});
  SolverLimitOptions options;
  options.bracket.guess = v.dt_safe, options.bracket.tolerance = 1e-3;
  const auto found = solver_limit(scene, state, options);
  table.add({packing, c.name, static_cast<double>(consistent.sliding) / static_cast<double>(consistent.contacts),
             v.dt_safe / dt0, v.dt_limit_upper / dt0, found.stable / dt0, found.unstable / dt0,
             found.unstable / v.dt_safe});
}

void add_packing(Table& table, const std::string& name, const Scene& scene, const State& state) {
  const double dt0 = step_interval(linearise(scene, state)).dt_limit_upper;
  for (const Case& c : damping_cases(2 / dt0)) add_row(table, name, c, scene, state, dt0);
}

/// Overdamped steps: what slides goes on sliding until it comes to rest, instead of swinging back. Cell as it moves.
void creep(Scene scene, State& state, int steps) {
  const Network net = linearise(scene, state);
  const double bound = splitting_bound(net, {.matrix_sweeps = 0}).value;
  scene.damping.mass = 0.1 * std::sqrt(bound);
  Engine engine(scene, state);
  for (int k = 0; k < steps; ++k) engine.step(1 / std::sqrt(bound));
}

/// Sheared slowly at constant volume until contacts slide, then left to come to rest.
void shear(const Scene& scene, State& state, int steps, double strain) {
  const double rate = strain / steps * std::sqrt(splitting_bound(linearise(scene, state), {.matrix_sweeps = 0}).value);
  state.cell.rate = Mat3{};
  state.cell.rate(0, 0) = state.cell.rate(1, 1) = 0.5 * rate, state.cell.rate(2, 2) = -rate;
  creep(scene, state, steps);
  state.cell.rate = Mat3{};
  creep(scene, state, 5000);
}

void add_sliding(Table& table, double friction) {
  Scene scene = test::scene_of("hertz-mindlin");
  scene.materials.front().friction = friction;
  State state = test::random_packing(scene, "uniform", 150, 1, 0.68, 4000);
  shear(scene, state, 20000, 0.01);
  const double dt0 = step_interval(linearise(scene, state)).dt_limit_upper;
  Case plain{"none", {}}, dashpots{"dashpots 0.2", {}}, local{"local 0.4", {}};
  dashpots.damping.normal_ratio = dashpots.damping.shear_ratio = 0.2, local.damping.local = 0.4;
  for (const Case& c : {plain, dashpots, local})
    add_row(table, fmt::format("sheared, µ {}", friction), c, scene, state, dt0);
}

int print_table(bool json) {
  Table table({{"packing"},
               {"damping"},
               {"sliding", "sliding", "share", 3},
               {"safe", "dt_safe", "dt0", 5},
               {"upper", "dt_limit_upper", "dt0", 5},
               {"measured_stable", "runs", "dt0", 5},
               {"measured_unstable", "blows up", "dt0", 5},
               {"margin", "blows up", "dt_safe", 5}});
  const Scene lattice = test::lattice_scene("hertz-mindlin", "fcc", {3, 3, 3}, 0.01);
  State crystal = test::state_of(lattice);
  { Engine lists(lattice, crystal); }
  add_packing(table, "FCC, 108", lattice, crystal);
  const Scene scene = test::scene_of("hertz-mindlin");
  for (const char* grading : {"uniform", "wide"})
    add_packing(table, fmt::format("{}, 150", grading), scene,
                test::random_packing(scene, grading, 150, 1, 0.68, 6000));
  for (const double friction : {0.1, 0.3}) add_sliding(table, friction);
  if (json)
    fmt::print("{}\n", table.json().dump(2));
  else
    fmt::print(
        "Largest stable step over the undamped limit dt0 of the same state; margin: the step that blows up over "
        "dt_safe.\n\n{}",
        table.text());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"The damped and sliding step against the solver", "table_damping"};
  bool json = false;
  app.add_flag("--json", json, "as JSON");
  return test::run_program(app, argc, argv, [&] { return print_table(json); });
}
