// eigengrain info [SCENE|SNAPSHOT]: what the program is, and what a scene uses.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <omp.h>

#include <nlohmann/json.hpp>

#include "app/commands.hpp"
#include "app/prepare.hpp"
#include "base/version.hpp"
#include "contact/laws.hpp"
#include "dynamics/engine.hpp"
#include "io/scene_file.hpp"
#include "specimen/lattice.hpp"

namespace eg {
namespace {

struct InfoFlags {
  std::string input;
  SceneSettings settings;
  bool memory = false, json = false;
};

struct ArraySize {
  std::string name;
  std::size_t bytes;
  bool per_contact;
};

template <class T>
std::size_t bytes_of(const T& v) {
  return v.size() * sizeof(typename T::value_type);
}

std::vector<ArraySize> arrays_of(const State& s, const ForceWorkspace& w) {
  return {{"position and radius", bytes_of(s.grains.position), false},
          {"velocity and mass", bytes_of(s.grains.velocity), false},
          {"spin and inertia", bytes_of(s.grains.spin), false},
          {"ids", bytes_of(s.grains.id), false},
          {"materials", bytes_of(s.grains.material), false},
          {"forces", bytes_of(w.rows), false},
          {"force schedule", bytes_of(w.schedule.gather_grain) + bytes_of(w.schedule.gather_row), false},
          {"reference positions", bytes_of(s.list.reference), false},
          {"neighbour list", bytes_of(s.list.begin) + bytes_of(s.list.j) + bytes_of(s.list.image), false},
          {"contact pairs",
           bytes_of(s.contacts.i) + bytes_of(s.contacts.j) + bytes_of(s.contacts.image) + bytes_of(w.schedule.target),
           true},
          {"contact history", bytes_of(s.contacts.history), true},
          {"wall contacts", bytes_of(s.wall_contacts), true}};
}

nlohmann::json scene_json(const Scene& scene, const State& state) {
  bool friction = false;
  for (const auto& m : scene.materials) friction = friction || m.friction > 0;
  return {{"title", scene.title},
          {"dimension", scene.dimension},
          {"particles", state.grains.size()},
          {"law", scene.contact.law},
          {"friction", friction},
          {"shear_history", state.contacts.history_vectors > 0},
          {"rotation", state.grains.rotates()},
          {"walls", state.walls.size()},
          {"periodic", state.cell.periodic},
          {"energy_ledger", scene.energy},
          {"timestep_policy", scene.timestep.policy},
          {"stages", scene.stages.size()}};
}

int info_command(const InfoFlags& flags) {
  if (flags.input.empty()) {
    const nlohmann::json j {
      {"version", version()}, {"compiler", __VERSION__}, {"batch_lanes", Batch::lanes},
#if defined(__AVX512F__)
          {"vector_bits", 512},
#elif defined(__AVX__)
          {"vector_bits", 256},
#else
          {"vector_bits", 128},
#endif
          {"threads", omp_get_max_threads()}, {"laws", law_names()}, {
        "lattices", lattice_names()
      }
    };
    if (flags.json)
      fmt::print("{}\n", j.dump(2));
    else
      fmt::print(
          "eigengrain {}\n  compiler   {}\n  vectors    {} bits\n  threads    {}\n  laws       {}\n  lattices   {}\n",
          version(), __VERSION__, j["vector_bits"].get<int>(), omp_get_max_threads(), fmt::join(law_names(), ", "),
          fmt::join(lattice_names(), ", "));
    return 0;
  }
  Snapshot s = read_input(flags.input, flags.settings);
  if (s.state.grains.size() == 0) s.state = make_specimen(s.scene);
  Engine engine(s.scene, s.state);
  nlohmann::json j = scene_json(s.scene, s.state);
  if (flags.memory) {
    double total = 0;
    const auto n = static_cast<double>(std::max<std::size_t>(1, s.state.grains.size()));
    for (const auto& a : arrays_of(s.state, engine.workspace())) {
      total += static_cast<double>(a.bytes);
      j["memory"].push_back(
          {{"array", a.name}, {"bytes", a.bytes}, {"bytes_per_particle", static_cast<double>(a.bytes) / n}});
    }
    j["bytes_per_particle"] = total / n;
  }
  if (flags.json) {
    fmt::print("{}\n", j.dump(2));
    return 0;
  }
  for (const auto& [key, value] : j.items())
    if (key != "memory") fmt::print("  {:<20}{}\n", key, value.is_string() ? value.get<std::string>() : value.dump());
  if (flags.memory)
    for (const auto& row : j["memory"])
      fmt::print("    {:<22}{:>12} B  {:>8.1f} B a particle\n", row["array"].get<std::string>(),
                 row["bytes"].get<std::size_t>(), row["bytes_per_particle"].get<double>());
  return 0;
}

}  // namespace

void add_info_command(CLI::App& app, Action& action) {
  auto* sub = app.add_subcommand("info", "what this program can do, or what a scene uses");
  auto flags = std::make_shared<InfoFlags>();
  sub->add_option("input", flags->input, "scene or snapshot");
  add_settings_option(*sub, flags->settings);
  sub->add_flag("--memory", flags->memory, "bytes by array");
  sub->add_flag("--json", flags->json, "print as JSON");
  sub->callback([flags, &action] { action = [flags] { return info_command(*flags); }; });
}

}  // namespace eg
