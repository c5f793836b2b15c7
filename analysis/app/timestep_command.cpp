// eigengrain timestep SCENE|SNAPSHOT|PACKING: the proved interval of the critical time step, beside the rules of thumb.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "app/commands.hpp"
#include "app/number_words.hpp"
#include "app/packing_input.hpp"
#include "app/slepc_program.hpp"
#include "app/timestep_report.hpp"
#include "assembly/linearise.hpp"
#include "base/error.hpp"
#include "base/progress.hpp"
#include "state/damping.hpp"
#include "timestep/verify.hpp"

namespace eg {
namespace {

struct TimestepFlags {
  PackingFlags packing;
  std::string figure, linearisation = "elastic", solver = "own";
  bool verify = false;
  double max_speed = Material::unset;
};

void draw_figure(const TimestepReport& report, const std::string& file) {
  if (file.empty()) return;
  if (report.estimates.empty())
    fmt::print(stderr, "no figure: nothing limits the step\n");
  else
    save_figure(figure_of(report), file);
}

/// Options that the program of --solver slepc does not serve would be lost without a word.
void refuse_with_slepc(const TimestepFlags& flags) {
  const PackingFlags& p = flags.packing;
  const char* lost = flags.verify                   ? "--verify"
                     : !flags.figure.empty()        ? "--figure"
                     : !std::isnan(flags.max_speed) ? "--max-speed"
                     : p.initial                    ? "--initial"
                     : !p.settings.empty()          ? "--set"
                     : p.bare.no_rotation           ? "--no-rotation"
                     : !p.bare_flag.empty()         ? p.bare_flag.c_str()
                                                    : nullptr;
  if (lost)
    throw InputError(
        fmt::format("eigengrain timestep: --solver slepc has no {}; leave it out, or take --solver own", lost));
}

int timestep_command(const TimestepFlags& flags) {
  const bool consistent = flags.linearisation == "consistent";
  if (flags.solver == "slepc") {
    refuse_with_slepc(flags);
    become_slepc_program(flags.packing.input, consistent, flags.packing.json);
  }
  check_figure(flags.figure);
  const Snapshot work = load_packing(flags.packing);

  const auto begin = std::chrono::steady_clock::now();
  TimestepReport report;
  report.name = flags.packing.input, report.title = work.scene.title;
  const Network net = linearise(work.scene, work.state);
  report.particles = net.size(), report.contacts = net.contacts();
  report.dimension = net.dimension, report.rotation = net.rotation;
  report.summary = summarise(net);
  report.interval = step_interval(net);
  report.damping = damping_in_force(work.scene, work.state);
  if (report.damping.any()) report.damped = damped_interval(net, report.damping, report.interval);
  if (consistent) report.consistent = consistent_report(work.scene, work.state, net);
  const Material& m = work.scene.materials.front();
  const auto known = [](double x) { return std::isnan(x) ? std::nullopt : std::optional<double>(x); };
  report.estimates =
      time_step_estimates(net, {known(m.shear_modulus), known(m.poisson), known(m.density), known(flags.max_speed)});
  if (report.interval.grain != no_index) {
    report.limiting_id = net.id[report.interval.grain];
    report.limiting_radius = net.radius[report.interval.grain];
  }
  if (flags.verify && report.interval.lambda_upper > 0) {
    Progress progress("stepping a perturbation", 1, "");
    BracketOptions options;
    options.guess = report.interval.dt_safe;
    options.progress = [&](double share) { progress.update(std::min(share, 1.0)); };
    report.bracket = verify_by_stepping(net, options);
  }
  report.elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();

  if (flags.packing.json)
    fmt::print("{}\n", json_of(report).dump(2));
  else
    fmt::print("{}", text_of(report));
  draw_figure(report, flags.figure);
  return 0;
}

}  // namespace

void add_timestep_command(CLI::App& app, Action& action) {
  auto* sub =
      app.add_subcommand("timestep", "the proved interval of the critical time step, beside the rules of thumb");
  auto f = std::make_shared<TimestepFlags>();
  add_packing_options(*sub, f->packing);
  sub->add_flag("--verify", f->verify, "bracket the limit by stepping a small perturbation, contacts held");
  sub->add_option("--figure", f->figure, "draw the rules of thumb against the limit (.svg, .png or .pdf)");
  sub->add_option(
         "--linearisation", f->linearisation,
         "elastic: every contact sticks; consistent: the exact tangent of the forces beside it, sliding included")
      ->check(CLI::IsMember({"elastic", "consistent"}));
  sub->add_option("--solver", f->solver, "own, or slepc: a snapshot shared among the processes of mpirun")
      ->check(CLI::IsMember({"own", "slepc"}));
  sub->add_option("--max-speed", f->max_speed, "largest relative speed at a contact, for Hertz's duration [m/s]")
      ->check(positive_option);
  sub->callback([f, &action] { action = [f] { return timestep_command(*f); }; });
}

}  // namespace eg
