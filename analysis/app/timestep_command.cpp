// eigengrain timestep SCENE|SNAPSHOT|PACKING: the proved interval of the critical time step, beside the rules of thumb.
#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>

#include "app/commands.hpp"
#include "app/prepare.hpp"
#include "app/timestep_report.hpp"
#include "assembly/linearise.hpp"
#include "base/error.hpp"
#include "base/progress.hpp"
#include "contact/laws.hpp"
#include "io/scene_file.hpp"
#include "measure/homogenised.hpp"
#include "timestep/verify.hpp"

namespace eg {
namespace {

struct TimestepFlags {
  std::string input, figure;
  SceneSettings settings;
  BareFlags bare;
  std::string bare_flag;  ///< one of those given that only a bare packing can take, or ""
  bool verify = false, json = false, initial = false;
  double max_speed = Material::unset;
  int threads = 0;
};

/// Long work must not end in a figure that cannot be written.
void check_figure(const std::string& path) {
  if (path.empty()) return;
  const auto ending = std::filesystem::path(path).extension();
  if (ending != ".svg" && ending != ".png" && ending != ".pdf")
    throw input_error(path, 0, "the figure", "has an ending that names no format", "use .svg, .png or .pdf");
}

Snapshot load(const TimestepFlags& flags) {
  if (kind_of(flags.input) == InputKind::packing && flags.settings.empty())
    return bare_packing(flags.input, flags.bare);
  if (!flags.bare_flag.empty())
    throw input_error(flags.input, 0, flags.bare_flag, "is for bare packings; a scene or snapshot has its own material",
                      "leave it out, or change a scene with --set");
  Snapshot s = read_input(flags.input, flags.settings);
  if (s.state.grains.size() > 0) return s;
  s.state = make_specimen(s.scene);
  if (!flags.initial && !s.scene.stages.empty()) run_quietly(s.scene, s.state);
  return s;
}

void draw_figure(const TimestepReport& report, const std::string& file) {
  if (file.empty()) return;
  if (report.estimates.empty()) {
    fmt::print(stderr, "no figure: nothing limits the step\n");
    return;
  }
  const std::filesystem::path path(file);
  std::error_code ignored;  // the figure's own message says that it cannot be written
  if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), ignored);
  write_figure(figure_of(report), file);
  fmt::print(stderr, "figure: {}\n", file);
}

int timestep_command(const TimestepFlags& flags) {
  check_figure(flags.figure);
  if (flags.threads > 0) omp_set_num_threads(flags.threads);
  Snapshot work = load(flags);
  if (flags.bare.no_rotation) work.scene.rotation = false, work.state.grains.spin.clear();
  { Engine lists(work.scene, work.state); }  // a state without lists gets them

  const auto begin = std::chrono::steady_clock::now();
  TimestepReport report;
  report.name = flags.input, report.title = work.scene.title;
  const Network net = linearise(work.scene, work.state);
  report.particles = net.size(), report.contacts = net.springs.size();
  report.dimension = net.dimension, report.rotation = net.rotation;
  report.summary = summarise(net);
  report.interval = step_interval(net);
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
    VerifyOptions options;
    options.guess = report.interval.dt_safe;
    options.progress = [&](double share) { progress.update(std::min(share, 1.0)); };
    report.bracket = verify_by_stepping(net, options);
  }
  report.elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();

  if (flags.json)
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
  sub->add_option("input", f->input,
                  "scene (its stages are run first), snapshot (.h5) or packing (text: Lx Ly Lz, then x y z r)")
      ->required();
  add_settings_option(*sub, f->settings);
  sub->add_flag("--verify", f->verify, "bracket the limit by stepping a small perturbation, contacts held");
  sub->add_flag("--initial", f->initial, "of a scene: the specimen before its stages");
  sub->add_flag("--json", f->json, "print the report as JSON");
  sub->add_option("--figure", f->figure, "draw the rules of thumb against the limit (.svg, .png or .pdf)");
  sub->add_option("--law", f->bare.law, "contact law of a bare packing")->check(CLI::IsMember(law_names()));
  sub->add_option("--shear-modulus", f->bare.shear_modulus, "G of a bare packing [Pa]");
  sub->add_option("--poisson", f->bare.poisson, "Poisson's ratio of a bare packing [-]");
  sub->add_option("--density", f->bare.density, "density of the grains of a bare packing [kg/m3]");
  sub->add_option("--friction", f->bare.friction, "friction coefficient of a bare packing [-]");
  sub->add_option("--normal-stiffness", f->bare.normal_stiffness, "kn of a bare packing, linear law [N/m]");
  sub->add_option("--shear-stiffness", f->bare.shear_stiffness, "ks of a bare packing, linear law [N/m]");
  sub->add_option("--arms", f->bare.arms,
                  "contact arms of a bare packing: overlap (R - d/2) or radius (R, as LAMMPS gran/*)")
      ->check(CLI::IsMember({"overlap", "radius"}));
  sub->add_flag("--no-rotation", f->bare.no_rotation, "without rotational degrees of freedom");
  sub->add_option("--max-speed", f->max_speed, "largest relative speed at a contact, for Hertz's duration [m/s]")
      ->check(CLI::Range(1e-9, 1e9));
  sub->add_option("--threads", f->threads, "threads (default: all)")->check(CLI::Range(1, 1024));
  sub->callback([f, sub, &action] {
    for (const char* flag : {"--law", "--shear-modulus", "--poisson", "--density", "--friction", "--normal-stiffness",
                             "--shear-stiffness", "--arms"})
      if (sub->count(flag) > 0) f->bare_flag = flag;
    action = [f] { return timestep_command(*f); };
  });
}

}  // namespace eg
