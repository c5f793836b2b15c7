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
#include "report/table.hpp"
#include "search/neighbours.hpp"
#include "specimen/lattice.hpp"
#include "state/friction.hpp"

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
};

template <class T>
std::size_t bytes_of(const T& v) {
  return v.size() * sizeof(typename T::value_type);
}

std::size_t bytes_of(const StandingBound& b) {
  return bytes_of(b.overlap) + bytes_of(b.weight) + bytes_of(b.wall_overlap) + bytes_of(b.grain);
}

/// What upkeep of the lists holds on to while a run goes on: here, what one renewal of them leaves.
std::size_t upkeep_bytes(State s) {
  ListScratch scratch;
  rebuild_neighbours(s, s.list.skin, s.list.contact_skin, scratch);
  const Contacts& c = scratch.contacts;
  return bytes_of(scratch.order) + bytes_of(scratch.place) + bytes_of(scratch.entries) + bytes_of(scratch.count) +
         bytes_of(c.i) + bytes_of(c.j) + bytes_of(c.image) + bytes_of(c.history) + bytes_of(c.friction);
}

std::vector<ArraySize> arrays_of(const State& s, const ForceWorkspace& w) {
  return {{"position and radius", bytes_of(s.grains.position)},
          {"velocity and mass", bytes_of(s.grains.velocity)},
          {"spin and inertia", bytes_of(s.grains.spin)},
          {"ids", bytes_of(s.grains.id)},
          {"materials", bytes_of(s.grains.material)},
          {"forces", bytes_of(w.rows)},
          {"force schedule", bytes_of(w.schedule.gather_grain) + bytes_of(w.schedule.gather_row)},
          {"reference positions", bytes_of(s.list.reference)},
          {"neighbour list", bytes_of(s.list.begin) + bytes_of(s.list.j) + bytes_of(s.list.image)},
          {"contact pairs", bytes_of(s.contacts.i) + bytes_of(s.contacts.j) + bytes_of(s.contacts.image) +
                                bytes_of(s.contacts.friction) + bytes_of(w.schedule.target)},
          {"contact history", bytes_of(s.contacts.history)},
          {"upkeep of the lists", upkeep_bytes(s)},
          {"bound of the step", bytes_of(s.policy.bound)},
          {"walls", bytes_of(s.walls)},
          {"wall contacts", bytes_of(s.wall_contacts)}};
}

/// Bytes by array, also over the number of grains and over that of listed contacts; a line with the sum ends it.
Table memory_table(const State& state, const ForceWorkspace& work) {
  Table table({{"array"},
               {"bytes", "bytes", "B"},
               {"bytes_per_particle", "a particle", "B"},
               {"bytes_per_contact", "a contact", "B"}});
  std::size_t pairs = 0, total = 0;
  for (std::size_t c = 0; c < state.contacts.size(); ++c) pairs += !state.contacts.is_padding(c);
  pairs += state.wall_contacts.size();
  const auto add = [&](const std::string& name, std::size_t bytes) {
    const auto over = [&](std::size_t n) {
      return n > 0 ? Value(static_cast<double>(bytes) / static_cast<double>(n)) : Value();
    };
    table.add({name, static_cast<std::int64_t>(bytes), over(state.grains.size()), over(pairs)});
    total += bytes;
  };
  for (const auto& a : arrays_of(state, work)) add(a.name, a.bytes);
  add("all", total);
  return table;
}

nlohmann::json scene_json(const Scene& scene, const State& state) {
  return {{"title", scene.title},
          {"dimension", scene.dimension},
          {"particles", state.grains.size()},
          {"law", scene.contact.law},
          {"friction", has_friction(scene)},
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
  if (flags.json) {
    if (flags.memory) j["memory"] = memory_table(s.state, engine.workspace()).json();
    fmt::print("{}\n", j.dump(2));
    return 0;
  }
  for (const auto& [key, value] : j.items())
    fmt::print("  {:<20}{}\n", key, value.is_string() ? value.get<std::string>() : value.dump());
  if (flags.memory) fmt::print("\n{}", memory_table(s.state, engine.workspace()).text());
  return 0;
}

}  // namespace

void add_info_command(CLI::App& app, Action& action) {
  auto* sub = app.add_subcommand("info", "what this program can do, or what a scene uses");
  auto flags = std::make_shared<InfoFlags>();
  sub->add_option("input", flags->input, "scene or snapshot");
  add_settings_option(*sub, flags->settings);
  sub->add_flag("--memory", flags->memory, "bytes by array, a particle and a listed contact");
  sub->add_flag("--json", flags->json, "print as JSON");
  sub->callback([flags, &action] { action = [flags] { return info_command(*flags); }; });
}

}  // namespace eg
