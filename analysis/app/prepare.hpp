#pragma once
// From what the user names (scene, snapshot or bare packing) to a scene and a state.
#include <CLI/CLI.hpp>
#include <functional>
#include <optional>
#include <string>

#include "dynamics/run.hpp"
#include "io/scene_file.hpp"
#include "io/snapshot.hpp"
#include "timestep/controller.hpp"

namespace eg {

/// Material and law for a bare packing, from flags; what is not given stays unset.
struct BareFlags {
  std::string law = "hertz-mindlin";
  double shear_modulus = Material::unset, poisson = Material::unset, density = Material::unset,
         friction = Material::unset;
  double normal_stiffness = Material::unset, shear_stiffness = Material::unset;
  std::string arms = "overlap";
  bool no_rotation = false;

  /// The material constants by their key in a scene.
  std::vector<std::pair<std::string_view, double>> constants() const {
    return {{"shear_modulus", shear_modulus},
            {"poisson", poisson},
            {"density", density},
            {"friction", friction},
            {"normal_stiffness", normal_stiffness},
            {"shear_stiffness", shear_stiffness}};
  }
};

/// What a file is, by its content.
enum class InputKind { scene, snapshot, packing };
InputKind kind_of(const std::string& path);

/// --set KEY=VALUE, as often as wanted; ends up in `settings`.
void add_settings_option(CLI::App& command, SceneSettings& settings);

/// A scene file, read with the settings, or a snapshot, for which there can be none. Throws InputError for a packing.
Snapshot read_input(const std::string& path, const SceneSettings& settings);

/// The scene's specimen as a state, before any stage.
State make_specimen(const Scene& scene);

/// A packing file with the material of the flags, as a scene. Throws InputError when a constant of the law is missing.
Snapshot bare_packing(const std::string& path, const BareFlags& flags);

/// How much of all stages is done [0, 1]; Progress::unknown unless every stage ends by steps, time or strain.
double run_share(const Scene& scene, const State& state);

/// Runs the remaining stages with a progress bar and nothing else (for commands that only want the packing);
/// `stage_end` is called at the end of each.
void run_quietly(const Scene& scene, State& state,
                 const std::function<void(const State&, const StageSpec&)>& stage_end = {});

/// A progress note of a run: "stage 1/2 compress 43 %: p = 1.00e+05 Pa, unbalanced 1.2e-04, dt = 1e-7 s".
std::string run_note(const Scene& scene, const State& state, const RunStatus& status);

/// How far a stage has come, where that can be told [0, 1]; else nothing.
std::optional<double> stage_share(const State& state, const StageSpec& stage);

}  // namespace eg
