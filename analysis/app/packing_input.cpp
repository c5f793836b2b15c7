#include "app/packing_input.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <filesystem>

#include "app/number_words.hpp"
#include "base/error.hpp"
#include "contact/laws.hpp"
#include "dynamics/engine.hpp"

namespace eg {
namespace {

Snapshot read_or_make(const PackingFlags& flags) {
  if (kind_of(flags.input) == InputKind::packing && flags.settings.empty())
    return bare_packing(flags.input, flags.bare);
  if (!flags.bare_flag.empty())
    throw input_error(flags.input, 0, flags.bare_flag, "is for bare packings; a scene or snapshot has its own material",
                      "leave it out, or change a scene with --set");
  Snapshot s = read_input(flags.input, flags.settings);
  if (s.state.grains.size() > 0) {
    if (flags.initial)
      throw input_error(flags.input, 0, "--initial", "is for scenes, and this is a snapshot", "leave it out");
    return s;
  }
  s.state = make_specimen(s.scene);
  if (!flags.initial && !s.scene.stages.empty()) run_quietly(s.scene, s.state);
  return s;
}

}  // namespace

void add_packing_options(CLI::App& command, PackingFlags& f) {
  command
      .add_option("input", f.input,
                  "scene (its stages are run first), snapshot (.h5) or packing (text: Lx Ly Lz, then x y z r)")
      ->required();
  add_settings_option(command, f.settings);
  command.add_flag("--initial", f.initial, "of a scene: the specimen before its stages");
  command.add_flag("--json", f.json, "print the report as JSON");
  const auto bare = [&](const char* name, auto& value, const char* text) {
    return command.add_option(name, value, text)->each([&f, name](const std::string&) { f.bare_flag = name; });
  };
  bare("--law", f.bare.law, "contact law of a bare packing")->check(CLI::IsMember(law_names()));
  bare("--shear-modulus", f.bare.shear_modulus, "G of a bare packing [Pa]")->check(finite_option);
  bare("--poisson", f.bare.poisson, "Poisson's ratio of a bare packing [-]")->check(finite_option);
  bare("--density", f.bare.density, "density of the grains of a bare packing [kg/m3]")->check(finite_option);
  bare("--friction", f.bare.friction, "friction coefficient of a bare packing [-]")->check(finite_option);
  bare("--normal-stiffness", f.bare.normal_stiffness, "kn of a bare packing, linear law [N/m]")->check(finite_option);
  bare("--shear-stiffness", f.bare.shear_stiffness, "ks of a bare packing, linear law [N/m]")->check(finite_option);
  bare("--arms", f.bare.arms, "contact arms of a bare packing: overlap (R - d/2) or radius (R, as LAMMPS gran/*)")
      ->check(CLI::IsMember({"overlap", "radius"}));
  command.add_flag("--no-rotation", f.bare.no_rotation, "without rotational degrees of freedom");
  command.add_option("--threads", f.threads, "threads (default: all)")->check(CLI::Range(1, 1024));
}

Snapshot load_packing(const PackingFlags& flags) {
  if (flags.threads > 0) omp_set_num_threads(flags.threads);
  Snapshot work = read_or_make(flags);
  if (flags.bare.no_rotation) work.scene.rotation = false, work.state.grains.spin.clear();
  { Engine lists(work.scene, work.state); }  // a state without lists gets them
  return work;
}

void check_figure(const std::string& path) {
  if (path.empty()) return;
  const auto ending = std::filesystem::path(path).extension();
  if (ending != ".svg" && ending != ".png" && ending != ".pdf")
    throw input_error(path, 0, "the figure", "has an ending that names no format", "use .svg, .png or .pdf");
}

void save_figure(const Figure& figure, const std::string& file) {
  const std::filesystem::path path(file);
  std::error_code ignored;  // the figure's own message says that it cannot be written
  if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), ignored);
  write_figure(figure, file);
  fmt::print(stderr, "figure: {}\n", file);
}

}  // namespace eg
