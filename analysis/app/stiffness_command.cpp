// eigengrain stiffness SCENE|SNAPSHOT|PACKING: the elastic tensor of a periodic packing, or the moduli that rigid walls
// see.
#include <fmt/format.h>

#include <chrono>

#include "app/commands.hpp"
#include "app/number_words.hpp"
#include "app/packing_input.hpp"
#include "app/spring_file.hpp"
#include "app/stiffness_report.hpp"
#include "app/stiffness_series.hpp"
#include "assembly/linearise.hpp"
#include "base/error.hpp"
#include "base/progress.hpp"
#include "measure/volume.hpp"
#include "stiffness/backbone.hpp"
#include "timestep/interval.hpp"

namespace eg {
namespace {

struct StiffnessFlags {
  PackingFlags packing;
  std::string figure, tables, springs, solver = "auto";
  double tolerance = RelaxationOptions{}.tolerance;
  bool probe = false, stages = false;
  std::vector<std::string> directions;
};

std::vector<Vec3> directions_of(const StiffnessFlags& flags, int dimension) {
  std::vector<Vec3> all;
  for (const auto& text : flags.directions) {
    Vec3 n;
    const char* rest = text.c_str();
    int read = 0, k = 0;
    for (; k < dimension && std::sscanf(rest, k == 0 ? "%lf%n" : ",%lf%n", &n[k], &read) == 1; ++k) rest += read;
    if (k < dimension || *rest != '\0' || !(norm(n) > 0 && std::isfinite(norm(n))))
      throw input_error(flags.packing.input, 0, "--direction " + text,
                        fmt::format("is not a direction of {} numbers", dimension),
                        dimension == 3 ? "write --direction 1,1,0" : "write --direction 1,1");
    all.push_back(n);
  }
  if (!all.empty()) return all;
  if (dimension == 2) return {{1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {1, 1, 1}};
}

/// Distances of parallel walls across x, y, z; 0 where there is no pair.
std::array<double, 3> wall_distances(const State& state) {
  std::array<double, 3> distance{};
  for (int k = 0; k < state.dimension; ++k)
    if (const double gap = wall_gap(state, k).length(); std::isfinite(gap)) distance[static_cast<std::size_t>(k)] = gap;
  return distance;
}

bool is_periodic(const State& state) {
  return state.cell.periodic[0] && state.cell.periodic[1] && (state.dimension == 2 || state.cell.periodic[2]);
}

LoadCases loads_of(const StiffnessFlags& flags, const State& state) {
  if (is_periodic(state)) return periodic_strains(state.dimension);
  LoadCases loads = platen_strains(wall_distances(state));
  if (loads.count() == 0)
    throw input_error(flags.packing.input, 0, "the packing",
                      "is neither periodic nor between parallel walls across x, y or z, so nothing strains it",
                      "set boundary.type = \"periodic\" or \"box\"");
  if (flags.probe)
    throw input_error(flags.packing.input, 0, "--probe", "strains a periodic cell, and this packing has walls",
                      "leave it out");
  return loads;
}

RelaxationOptions options_of(const StiffnessFlags& flags) {
  using Solver = RelaxationOptions::Solver;
  return {flags.solver == "cg"         ? Solver::conjugate_gradients
          : flags.solver == "cholesky" ? Solver::cholesky
                                       : Solver::automatic,
          flags.tolerance,
          {}};
}

void strain_it(const Snapshot& work, const Network& network, StiffnessReport& report) {
  const double limit = step_interval(network).dt_safe;
  Progress progress("straining the packing", 1, "");
  ProbeOptions options;
  options.step = 0.8 * limit;
  options.progress = [&](double share) { progress.update(share); };
  report.probed = probe(work.scene, work.state, options);
}

StiffnessReport analyse(const StiffnessFlags& flags, const Snapshot& work) {
  const State& state = work.state;
  const LoadCases loads = loads_of(flags, state);
  const Network network = linearise(work.scene, state);
  if (!flags.springs.empty()) write_springs(network, flags.springs);
  const auto begin = std::chrono::steady_clock::now();
  const BackboneNetwork bone = backbone(network);
  StiffnessReport r;
  r.name = flags.packing.input, r.title = work.scene.title;
  r.dimension = network.dimension, r.rotation = network.rotation, r.periodic = is_periodic(state);
  r.particles = network.size(), r.rattlers = bone.rattlers, r.contacts = bone.network.contacts();
  r.state = homogenise(work.scene, state);
  r.volume = r.state.volume;
  for (const double inverse : network.inverse_mass) r.density += inverse > 0 ? 1 / inverse / r.volume : 0;
  r.loads = loads.names;
  RelaxationOptions options = options_of(flags);
  Progress progress("relaxing", loads.count(), "loads");
  options.progress = [&](double done) { progress.update(done); };
  r.moduli = relax(bone.network, loads, r.volume, options);
  progress.finish();
  r.elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (r.contacts == 0) return r;
  if (r.periodic) complete(r, bone.network, directions_of(flags, r.dimension), work.scene.materials.front());
  if (flags.probe) strain_it(work, network, r);
  return r;
}

/// --stages: the same for every stage of a scene, in brief.
int series_command(const StiffnessFlags& flags) {
  if (flags.probe || !flags.springs.empty() || !flags.directions.empty())
    throw input_error(flags.packing.input, 0, "--stages", "gives the isotropic moduli of every stage alone",
                      "leave out --probe, --springs and --direction, or ask for one snapshot");
  PackingFlags start = flags.packing;
  start.initial = true;
  const Snapshot work = load_packing(start);
  const StiffnessSeries series = stiffness_series(flags.packing.input, work.scene, work.state, options_of(flags));
  if (flags.packing.json)
    fmt::print("{}\n", json_of(series).dump(2));
  else
    fmt::print("{}", text_of(series));
  if (!flags.tables.empty()) write_tables(series, flags.tables);
  if (!flags.figure.empty()) save_figure(figure_of(series), flags.figure);
  return series.converged ? 0 : 3;
}

int stiffness_command(const StiffnessFlags& flags) {
  check_figure(flags.figure);
  if (flags.stages) return series_command(flags);
  const Snapshot work = load_packing(flags.packing);
  directions_of(flags, work.state.dimension);  // wrong ones are told before the work
  const StiffnessReport report = analyse(flags, work);
  if (flags.packing.json)
    fmt::print("{}\n", json_of(report).dump(2));
  else
    fmt::print("{}", text_of(report));
  if (!flags.tables.empty()) write_tables(report, flags.tables);
  if (!flags.figure.empty() && report.periodic && report.contacts > 0)
    save_figure(figure_of(report), flags.figure);
  else if (!flags.figure.empty())
    fmt::print(stderr, "no figure: it shows wave speeds, which only periodic packings that touch have here\n");
  return report.moduli.converged && (!report.probed || report.probed->found) ? 0 : 3;
}

}  // namespace

void add_stiffness_command(CLI::App& app, Action& action) {
  auto* sub = app.add_subcommand("stiffness", "elastic tensor and wave speeds of a packing, from its contacts");
  auto f = std::make_shared<StiffnessFlags>();
  add_packing_options(*sub, f->packing);
  sub->add_flag("--probe", f->probe, "find the moduli a second time by straining the packing itself, step by step");
  sub->add_flag("--stages", f->stages, "moduli after every stage of a scene, and their exponents of the mean stress");
  sub->add_option("--direction", f->directions, "E, ν and wave speeds along this one, e.g. 1,1,0; repeatable")
      ->type_size(1)
      ->allow_extra_args(false);
  sub->add_option("--figure", f->figure, "draw wave speeds over the angle (.svg, .png or .pdf)");
  sub->add_option("--tables", f->tables, "write moduli and speeds over the sphere to this HDF5 file");
  sub->add_option("--springs", f->springs, "write masses and springs to this text file (matlab_compat/README.md)");
  sub->add_option("--solver", f->solver, "auto: cholesky for small packings, else cg (conjugate gradients)")
      ->check(CLI::IsMember({"auto", "cg", "cholesky"}));
  sub->add_option("--tolerance", f->tolerance, "relative error of the moduli at which cg stops (1e-10)")
      ->check(finite_option)
      ->check(CLI::Range(1e-14, 0.1));
  sub->callback([f, &action] { action = [f] { return stiffness_command(*f); }; });
}

}  // namespace eg
