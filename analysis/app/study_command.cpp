// eigengrain study SCENE: where each rule of thumb for the time step fails, and by what factor.
#include <fmt/format.h>

#include <filesystem>

#include "app/commands.hpp"
#include "app/packing_input.hpp"
#include "app/timestep_study.hpp"
#include "base/error.hpp"
#include "io/scene_file.hpp"

namespace eg {
namespace {

struct StudyFlags {
  std::string scene, figure;
  SceneSettings settings;
  bool json = false;
};

int study_command(const StudyFlags& flags) {
  check_figure(flags.figure);
  const Scene scene = read_scene(flags.scene, flags.settings);
  const auto rows = timestep_study(scene, [](const std::string& done) { fmt::print(stderr, "done: {}\n", done); });
  if (flags.json)
    fmt::print("{}\n", json_of(rows).dump(2));
  else
    fmt::print("{}", text_of(rows));
  if (!flags.figure.empty()) save_figure(figure_of(rows), flags.figure);
  return 0;
}

}  // namespace

void add_study_command(CLI::App& app, Action& action) {
  auto* sub = app.add_subcommand("study", "where each rule of thumb for the time step fails, and by what factor");
  auto flags = std::make_shared<StudyFlags>();
  sub->add_option("scene", flags->scene, "scene of a study, cases/timestep_study.toml")->required();
  add_settings_option(*sub, flags->settings);
  sub->add_option("--figure", flags->figure, "draw rules against the limit over stress (.svg, .png or .pdf)");
  sub->add_flag("--json", flags->json, "print every row as JSON");
  sub->callback([flags, &action] { action = [flags] { return study_command(*flags); }; });
}

}  // namespace eg
