// eigengrain run SCENE|SNAPSHOT: the stages of a scene, with history, snapshots and a result file.
#include <fmt/format.h>
#include <omp.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/commands.hpp"
#include "app/interrupt.hpp"
#include "app/prepare.hpp"
#include "app/record.hpp"
#include "base/error.hpp"
#include "base/progress.hpp"
#include "base/version.hpp"
#include "boundary/cell_control.hpp"
#include "dynamics/bonds.hpp"
#include "io/scene_file.hpp"
#include "io/snapshot.hpp"
#include "io/text_file.hpp"
#include "io/vtk.hpp"
#include "measure/homogenised.hpp"

namespace eg {
namespace {

namespace fs = std::filesystem;

struct RunFlags {
  std::string input, out;
  SceneSettings settings;
  bool overwrite = false, json = false, scalar = false;
  int threads = 0;
};

/// Takes away what an earlier run has written, so that nothing of it stays beside the new results.
void clear_results(const fs::path& folder) {
  for (const char* name :
       {"history.csv", "timestep.csv", "final.h5", "final.vtp", "result.json", "resume.h5", "failed.h5"})
    fs::remove(folder / name);
  std::vector<fs::path> snapshots;
  for (const auto& file : fs::directory_iterator(folder)) {
    const std::string name = file.path().filename().string();
    if (file.path().extension() == ".h5" && (name.starts_with("step_") || name.starts_with("stage_")))
      snapshots.push_back(file.path());
  }
  for (const auto& file : snapshots) fs::remove(file);
}

/// The histories of a run that goes on in another folder.
void bring_histories(const fs::path& from, const fs::path& to) {
  for (const char* name : {"history.csv", "timestep.csv"})
    if (fs::exists(from / name)) fs::copy_file(from / name, to / name);
}

/// Where results go; refuses to bury those of another run.
fs::path result_folder(const RunFlags& flags, bool resumed) {
  const fs::path input(flags.input), home = input.has_parent_path() ? input.parent_path() : fs::path(".");
  if (resumed && flags.out.empty()) return home;
  const fs::path folder = flags.out.empty() ? fs::path("out") / input.stem() : fs::path(flags.out);
  std::error_code error;
  if (resumed && fs::equivalent(folder, home, error)) return folder;
  const bool used = fs::exists(folder / "history.csv");
  if (used && !flags.overwrite)
    throw InputError(
        fmt::format("{}: holds the results of an earlier run; name another folder with --out, or say --overwrite",
                    folder.string()));
  fs::create_directories(folder, error);
  if (error)
    throw InputError(
        fmt::format("{}: cannot be made a folder ({}); name another with --out", folder.string(), error.message()));
  if (used) clear_results(folder);
  if (resumed) bring_histories(home, folder);
  return folder;
}

/// Everything that is written while a run goes on.
class Recorder {
 public:
  Recorder(const Scene& scene, const State& state, fs::path folder, bool resumed)
      : scene_(scene),
        folder_(std::move(folder)),
        history_(open("history.csv", history_columns(scene), state, resumed)),
        changes_(open("timestep.csv", step_columns(), state, resumed)) {}

  /// The step was chosen anew; `share`: of the wall clock so far that choosing and checking took.
  void step_change(const State& state, double share) { changes_.append(state.step, step_row(state, share)); }
  void row(const State& state) {
    const Homogenised h = homogenise(scene_, state);
    history_.append(state.step, history_row(scene_, state, h));
    for (const auto& line : broken_assumptions(scene_, state, h)) warn(state, line.substr(0, line.find(' ')), line);
  }
  /// A line a kind of trouble, the first one seen.
  void warn(const State& state, const std::string& kind, const std::string& line) {
    if (seen_.contains(kind)) return;
    fmt::print(stderr, "warning: step {}: {}\n", state.step, line);
    seen_[kind] = fmt::format("step {}: {}", state.step, line);
  }
  void stage_end(const State& state, const StageSpec& stage) {
    if (stage.snapshot_at_end) snapshot(state, "stage_" + stage.name);
    const TargetMiss miss = worst_target(state, stage);
    if (miss.relative > 0.01)
      warn(state, "target of " + stage.name,
           fmt::format("stage \"{}\" ends {:.1f} % off its target: {}; raise max_strain_rate, drive slower, or the "
                       "packing cannot bear it",
                       stage.name, 100 * miss.relative, miss.text));
  }
  std::string snapshot(const State& state, const std::string& name) const {
    const std::string path = (folder_ / (name + ".h5")).string();
    write_snapshot(path, scene_, state);
    return path;
  }
  const fs::path& folder() const { return folder_; }
  nlohmann::json warnings() const {
    auto list = nlohmann::json::array();
    for (const auto& [kind, text] : seen_) list.push_back(text);
    return list;
  }

 private:
  History open(const char* name, const std::vector<HistoryColumn>& columns, const State& state, bool resumed) const {
    const std::string path = (folder_ / name).string();
    return resumed ? History::resume(path, columns, state.step) : History::create(path, columns);
  }

  const Scene& scene_;
  fs::path folder_;
  History history_, changes_;
  std::map<std::string, std::string> seen_;
};

nlohmann::json certificate_json(const ControllerLog& log) {
  nlohmann::json causes;
  for (std::size_t c = 0; c < step_causes; ++c) causes[step_cause_name(static_cast<StepCause>(c))] = log.evaluations[c];
  return {{"evaluations", causes},
          {"checks", log.checks},
          {"grains_mended", log.mended},
          {"outruns", log.outruns},
          {"largest_dt_over_certified", log.worst_ratio},
          {"largest_dt_over_limit_upper", log.worst_true},
          {"seconds", log.seconds}};
}

nlohmann::json result_json(const Scene& scene, const State& state, const ControllerLog& log, double seconds,
                           const Recorder& recorder) {
  const Homogenised h = homogenise(scene, state);
  const auto s = stress_components(state);
  nlohmann::json j{{"title", scene.title},
                   {"version", version()},
                   {"steps", state.step},
                   {"time_s", state.time},
                   {"particles", state.grains.size()},
                   {"stress_Pa", s},
                   {"mean_stress_Pa", mean_stress(state)},
                   {"void_ratio", h.void_ratio},
                   {"solid_fraction", h.solid_fraction},
                   {"coordination", h.coordination.mean},
                   {"mechanical_coordination", h.coordination.mechanical},
                   {"backbone_coordination", h.backbone.mean},
                   {"largest_overlap", h.largest_overlap},
                   {"unbalanced_force", h.unbalanced_force},
                   {"dt_s", state.dt},
                   {"dt_certified_s", state.policy.safe},
                   {"certificate_evaluations", log.all_evaluations()},
                   {"certificate", certificate_json(log)},
                   {"certificate_share", seconds > 0 ? log.seconds / seconds : 0.0},
                   {"elapsed_s", seconds},
                   {"warnings", recorder.warnings()}};
  if (scene.energy) {
    const auto& e = state.ledger;
    j["energy_J"] = {{"boundary", e.boundary},         {"body", e.body},
                     {"friction", e.friction},         {"local_damping", e.local_damping},
                     {"mass_damping", e.mass_damping}, {"viscous_damping", e.viscous_damping}};
  }
  if (state.bonds.made > 0)
    j["bonds"] = {{"made", state.bonds.made},
                  {"intact", intact_bonds(state)},
                  {"pulled", state.bonds.pulled},
                  {"cut", state.bonds.cut}};
  return j;
}

/// Keeps the state of a run that cannot go on; says where, or why not.
std::string keep_failed(const Recorder& recorder, const State& state) {
  try {
    return "state kept in " + recorder.snapshot(state, "failed");
  } catch (const RunError& e) {
    return e.what();
  }
}

void print_result(const nlohmann::json& j, const fs::path& folder, int dimension) {
  fmt::print("{} grains, {} steps, {:.6g} s simulated in {}\n", j["particles"].get<std::size_t>(),
             j["steps"].get<std::uint64_t>(), j["time_s"].get<double>(), duration_text(j["elapsed_s"].get<double>()));
  fmt::print("  mean stress              {:.6g} {}\n  void ratio               {:.5f}  (solid fraction {:.5f})\n",
             j["mean_stress_Pa"].get<double>(), dimension == 3 ? "Pa" : "N/m", j["void_ratio"].get<double>(),
             j["solid_fraction"].get<double>());
  fmt::print("  coordination Z, Z_m      {:.3f}, {:.3f}  (without rattlers {:.3f})\n", j["coordination"].get<double>(),
             j["mechanical_coordination"].get<double>(), j["backbone_coordination"].get<double>());
  if (j.contains("bonds"))
    fmt::print("  bonds                    {} of {} hold, {} broke by tension, {} by shear\n",
               j["bonds"]["intact"].dump(), j["bonds"]["made"].dump(), j["bonds"]["pulled"].dump(),
               j["bonds"]["cut"].dump());
  fmt::print("  largest overlap          {:.3g} % of the smaller diameter\n", 100 * j["largest_overlap"].get<double>());
  fmt::print(
      "  time step                {:.4g} s, certified limit {:.4g} s ({} evaluations, {:.1f} % of the run time)\n",
      j["dt_s"].get<double>(), j["dt_certified_s"].get<double>(), j["certificate_evaluations"].get<std::uint64_t>(),
      100 * j["certificate_share"].get<double>());
  fmt::print("written: {0}/history.csv, {0}/final.h5, {0}/final.vtp, {0}/result.json\n", folder.string());
}

int run_command(const RunFlags& flags) {
  if (flags.threads > 0) omp_set_num_threads(flags.threads);
  Snapshot work = read_input(flags.input, flags.settings);
  const bool resumed = work.state.grains.size() > 0;
  const Scene& scene = work.scene;
  if (!resumed) work.state = make_specimen(scene);
  State& state = work.state;
  if (scene.stages.empty())
    throw InputError(
        fmt::format("{}: has no [[stage]] to run; add one, or ask `eigengrain timestep {}`", scene.file, flags.input));
  if (resumed && state.stage >= scene.stages.size())
    throw InputError(fmt::format("{}: this run is complete, there is nothing to go on with", flags.input));

  const fs::path folder = result_folder(flags, resumed);
  if (resumed && state.step > 0 && !fs::exists(folder / "history.csv"))
    fmt::print(stderr, "warning: {} holds no history.csv; the history begins at step {}\n", folder.string(),
               state.step);
  Recorder recorder(scene, state, folder, resumed);
  Controller controller(scene);
  const auto begin = std::chrono::steady_clock::now();
  const auto elapsed = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(); };
  controller.on_change = [&](const State& s) { recorder.step_change(s, controller.log().seconds / elapsed()); };
  Progress progress(scene.title, 0, "steps");
  RunObserver observer;
  catch_interrupts();
  observer.step = [&](const State& s, const RunStatus& status) {
    progress.update(static_cast<double>(s.step), run_share(scene, s), [&] { return run_note(scene, s, status); });
  };
  observer.record = [&](const State& s, const RunStatus&) { recorder.row(s); };
  observer.snapshot = [&](const State& s) { recorder.snapshot(s, fmt::format("step_{:09d}", s.step)); };
  observer.stage_end = [&](const State& s, const StageSpec& stage) {
    progress.clear();
    fmt::print(stderr, "stage \"{}\" done: step {}, mean stress {:.6g} {}\n", stage.name, s.step, mean_stress(s),
               scene.dimension == 3 ? "Pa" : "N/m");
    recorder.stage_end(s, stage);
  };
  observer.stop = interrupted;
  bool complete = false;
  try {
    complete = run_stages(scene, state, controller, observer, flags.scalar);
  } catch (const RunError& e) {
    throw RunError(fmt::format("{} ({})", e.what(), keep_failed(recorder, state)));
  }
  progress.finish();
  if (!complete) {
    const std::string path = recorder.snapshot(state, "resume");
    fmt::print(stderr, "interrupted at step {}; go on with: eigengrain run {}\n", state.step, path);
    return 130;
  }
  recorder.snapshot(state, "final");
  write_vtp((recorder.folder() / "final.vtp").string(), state);
  const double seconds = elapsed();
  const auto result = result_json(scene, state, controller.log(), seconds, recorder);
  write_file((recorder.folder() / "result.json").string(), result.dump(2) + "\n");
  if (flags.json)
    fmt::print("{}\n", result.dump(2));
  else
    print_result(result, recorder.folder(), scene.dimension);
  return 0;
}

}  // namespace

void add_run_command(CLI::App& app, Action& action) {
  auto* sub = app.add_subcommand("run", "run the stages of a scene, or go on from a snapshot");
  auto flags = std::make_shared<RunFlags>();
  sub->add_option("input", flags->input, "scene file (.toml), or snapshot (.h5) to go on from")->required();
  add_settings_option(*sub, flags->settings);
  sub->add_option("--out", flags->out, "folder for results (default: out/<name of the scene>)");
  sub->add_flag("--overwrite", flags->overwrite, "replace the results of an earlier run");
  sub->add_flag("--json", flags->json, "print the result as JSON");
  sub->add_flag("--scalar", flags->scalar, "the reference force loop, one contact at a time");
  sub->add_option("--threads", flags->threads, "threads (default: all; results do not depend on it)")
      ->check(CLI::Range(1, 1024));
  sub->callback([flags, &action] { action = [flags] { return run_command(*flags); }; });
}

}  // namespace eg
