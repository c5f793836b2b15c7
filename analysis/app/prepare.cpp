#include "app/prepare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "base/error.hpp"
#include "base/progress.hpp"
#include "boundary/cell_control.hpp"
#include "io/packing_file.hpp"
#include "io/scene_file.hpp"
#include "specimen/lattice.hpp"
#include "specimen/make_packing.hpp"
#include "specimen/make_state.hpp"
#include "state/friction.hpp"

namespace eg {

InputKind kind_of(const std::string& path) {
  if (!std::filesystem::exists(path)) throw input_error(path, 0, "the file", "does not exist", "check the path");
  if (std::filesystem::is_directory(path))
    throw input_error(path, 0, "this", "is a folder, not a file", "name a scene, a snapshot or a packing");
  if (looks_like_snapshot(path)) return InputKind::snapshot;
  const auto ending = std::filesystem::path(path).extension();
  if (ending == ".toml") return InputKind::scene;
  if (ending == ".h5")
    throw input_error(path, 0, "this", "is no snapshot in spite of its name", "take a file that a run has written");
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) {
    const auto first = line.find_first_not_of(" \t\r");
    if (first == std::string::npos || line[first] == '#') continue;
    return std::isdigit(static_cast<unsigned char>(line[first])) || line[first] == '.' || line[first] == '+' ||
                   line[first] == '-'
               ? InputKind::packing
               : InputKind::scene;
  }
  return InputKind::packing;  // its reader says that it is empty
}

void add_settings_option(CLI::App& command, SceneSettings& settings) {
  command
      .add_option("--set", settings,
                  "KEY=VALUE in the place of what the scene says, e.g. specimen.count=300; repeatable")
      ->type_size(1)
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
}

Snapshot read_input(const std::string& path, const SceneSettings& settings) {
  switch (kind_of(path)) {
    case InputKind::scene:
      return {read_scene(path, settings), {}};
    case InputKind::snapshot:
      if (settings.empty()) return read_snapshot(path);
      throw input_error(path, 0, "--set", "changes scenes, and this is a snapshot", "set it when the run begins");
    case InputKind::packing:
      break;
  }
  throw input_error(path, 0, "this", "is a packing, neither scene nor snapshot",
                    "name it in a scene: [specimen] source = \"file\", path = \"…\"");
}

namespace {

/// Centres and radii alone.
Packing bare_grains(const State& state) {
  Packing packing;
  packing.dimension = state.dimension;
  for (int k = 0; k < state.dimension; ++k) packing.box[k] = state.cell.h(k, k);
  for (const Quad& x : state.grains.position) packing.position.push_back(x.vec()), packing.radius.push_back(x.w);
  return packing;
}

/// Packings that cannot be made are faults of the scene's numbers.
Packing packing_of(const Scene& scene) {
  try {
    return make_packing(scene);
  } catch (const RunError& e) {
    throw scene_error(scene, "specimen", "specimen:", e.what());
  }
}

/// The largest stress that a stage asks for [Pa] (2D: N/m).
double largest_target(const StageSpec& stage) {
  double most = std::abs(stage.membrane_stress);
  for (const auto& c : stage.control)
    if (c.kind == ComponentControl::Kind::stress) most = std::max(most, std::abs(c.value));
  for (const auto& drive : stage.bodies)
    if (drive.servo == BodyDrive::Servo::stress) most = std::max(most, std::abs(drive.target));
  return most;
}

/// A modulus in GPa instead of Pa, or a stress in kPa, would else end in a cell that has shrunk to nothing.
void check_stiffness(const Scene& scene, const State& state) {
  constexpr double senseless = 0.3;  // overlap over diameter
  const auto lattice = find_lattice(state.dimension == 3 ? "fcc" : "hexagonal");
  double radius = 0;
  for (const Quad& x : state.grains.position) radius += x.w / static_cast<double>(state.grains.size());
  const double carried = lattice_pressure(*lattice, radius, senseless, normal_force(scene));
  for (const auto& stage : scene.stages) {
    if (largest_target(stage) <= carried) continue;
    const Material& m = scene.materials.front();
    const bool modulus = !std::isnan(m.shear_modulus);
    const std::string key = fmt::format("material.{}.{}", m.name, modulus ? "shear_modulus" : "normal_stiffness");
    throw scene_error(
        scene, key, fmt::format("{} = {:g}", key, modulus ? m.shear_modulus : m.normal_stiffness),
        fmt::format("is too soft: grains would overlap by more than {:.0f} % of their diameter under the "
                    "{:g} {} of stage \"{}\"",
                    100 * senseless, largest_target(stage), state.dimension == 3 ? "Pa" : "N/m", stage.name),
        modulus ? "give it in Pa (quartz: 29e9), and stresses too" : "give it in N/m, stresses in Pa");
  }
}

State stated(const Scene& scene) {
  if (scene.specimen.source != SpecimenSpec::Source::file) return make_state(scene, packing_of(scene));
  const std::string path = resolve_path(scene, scene.specimen.path);
  if (!std::filesystem::exists(path))
    throw scene_error(scene, "specimen.path", fmt::format("specimen.path = \"{}\"", scene.specimen.path),
                      "names a file that is not there", "paths start from the folder of the scene");
  const bool periodic = scene.boundary.kind == BoundarySpec::Kind::periodic;
  if (!looks_like_snapshot(path)) return make_state(scene, read_packing(path, periodic));
  State state = read_snapshot(path).state;  // grains, contacts and cell; the new scene's stages begin
  if (state.dimension != scene.dimension)
    throw input_error(scene.file, 0, "specimen.path",
                      fmt::format("is a {}D snapshot in a {}D scene", state.dimension, scene.dimension));
  if (scene.specimen.trim) return make_state(scene, bare_grains(state));
  state.stage = 0, state.step = 0, state.time = 0, state.ledger = {}, state.policy = {}, state.dt = 0;
  state.friction.clear();
  fit_rotation(scene, state);
  scatter_friction(state, friction_scatter(scene));
  return state;
}

}  // namespace

State make_specimen(const Scene& scene) {
  State state = stated(scene);
  check_stiffness(scene, state);
  return state;
}

Snapshot bare_packing(const std::string& path, const BareFlags& f) {
  const Packing packing = read_packing(path);
  SceneSettings settings{fmt::format("dimension={}", packing.dimension),
                         fmt::format("rotation={}", !f.no_rotation),
                         "material.grain={}",
                         "contact.law=" + f.law,
                         "contact.arms=" + f.arms,
                         "specimen={source=\"file\", path=\"packing\"}",
                         "boundary.type=periodic"};
  for (const auto& [key, value] : f.constants())
    if (!std::isnan(value)) settings.push_back(fmt::format("material.grain.{}={}", key, value));
  try {
    const Scene scene = parse_scene("title = \"bare packing\"", path, settings);
    return {scene, make_state(scene, packing)};
  } catch (const InputError& e) {
    throw InputError(
        fmt::format("{}; the material of a bare packing comes from flags, e.g. --law hertz-mindlin "
                    "--shear-modulus 29e9 --poisson 0.12 --density 2650 --friction 0.25",
                    e.what()));
  }
}

std::optional<double> stage_share(const State& state, const StageSpec& s) {
  double share = 2;
  const auto count = [&](double done, double target) {
    if (!std::isnan(target)) share = std::min(share, target > 0 ? done / target : 1.0);
  };
  count(static_cast<double>(state.stage_step), s.until_steps);
  count(state.stage_time, s.until_time);
  count(axial_strain(state), s.until_axial_strain);
  count(shear_strain(state), s.until_shear_strain);
  count(static_cast<double>(state.cycle.turns) / 2, s.until_cycles);
  if (share > 1.5) return std::nullopt;
  return std::min(share, 1.0);
}

double run_share(const Scene& scene, const State& state) {
  const auto counted = [](const StageSpec& s) {
    return !(std::isnan(s.until_steps) && std::isnan(s.until_time) && std::isnan(s.until_axial_strain) &&
             std::isnan(s.until_shear_strain) && std::isnan(s.until_cycles)) &&
           std::isnan(s.until_stress_error) && std::isnan(s.until_unbalanced);
  };
  if (!std::ranges::all_of(scene.stages, counted)) return Progress::unknown;
  const double now = state.stage < scene.stages.size() ? stage_share(state, scene.stages[state.stage]).value_or(0) : 0;
  return (static_cast<double>(state.stage) + now) / static_cast<double>(scene.stages.size());
}

std::string run_note(const Scene& scene, const State& state, const RunStatus& status) {
  const auto share = stage_share(state, status.stage);
  return fmt::format("stage {}/{} {}{}: p = {:.4g} {}, unbalanced {:.1e}, dt = {:.3g} s", state.stage + 1,
                     scene.stages.size(), status.stage.name,
                     share ? fmt::format(" {:.0f} %", std::floor(100 * *share)) : "", mean_stress(state),
                     state.dimension == 3 ? "Pa" : "N/m", status.unbalanced, state.dt);
}

void run_quietly(const Scene& scene, State& state,
                 const std::function<void(const State&, const StageSpec&)>& stage_end) {
  Controller controller(scene);
  Progress progress("preparing", 0, "steps");
  RunObserver observer;
  observer.stage_end = stage_end;
  observer.step = [&](const State& s, const RunStatus& status) {
    progress.update(static_cast<double>(s.step), run_share(scene, s), [&] { return run_note(scene, s, status); });
  };
  run_stages(scene, state, controller, observer);
}

}  // namespace eg
