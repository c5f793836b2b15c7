// eigengrain waves modes: vibration modes of a packing and their density.
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <filesystem>

#include "app/number_words.hpp"
#include "app/packing_input.hpp"
#include "app/waves_commands.hpp"
#include "assembly/linearise.hpp"
#include "assembly/stiffness.hpp"
#include "base/error.hpp"
#include "base/progress.hpp"
#include "io/hdf5_file.hpp"
#include "io/vtk.hpp"
#include "report/table.hpp"
#include "waves/density.hpp"

namespace eg {
namespace {

constexpr std::size_t dense_density_rows = 3000;  // beyond, minutes; the kernel polynomial takes seconds
constexpr std::size_t most_dense_rows = 20000;

struct ModesFlags {
  PackingFlags packing;
  int lowest = 0, highest = 0;
  std::vector<double> between;  ///< two frequencies [Hz]
  bool all = false;
  std::string states;  ///< of the density of states: "", "auto", "dense", "kernel"
  int bins = 50;
  KernelOptions kernel;
  std::string figure, tables, shapes;

  bool wants_modes() const { return lowest > 0 || highest > 0 || !between.empty() || all; }
};

struct ModesReport {
  std::string name, title;
  std::size_t particles = 0, contacts = 0;
  std::optional<ModeSet> modes;
  std::optional<Density> density;
  double elapsed = 0;  ///< [s]
};

void require_dense(const ModesFlags& flags, std::size_t rows) {
  if (rows > most_dense_rows)
    throw input_error(
        flags.packing.input, 0, "the packing",
        fmt::format("has {} degrees of freedom, more than the {} of a dense problem", rows, most_dense_rows),
        "ask for --lowest, --highest or --between, or --states kernel");
}

ModeSet find_modes(const ModesFlags& flags, const Network& net) {
  if (flags.lowest > 0) return lowest_modes(net, static_cast<std::size_t>(flags.lowest));
  if (flags.highest > 0) return highest_modes(net, static_cast<std::size_t>(flags.highest));
  if (!flags.between.empty()) return modes_between(net, flags.between[0], flags.between[1]);
  require_dense(flags, total_dofs(net));
  return all_modes(net, true);
}

Density find_density(const ModesFlags& flags, const Network& net, const std::optional<ModeSet>& modes) {
  const std::size_t rows = total_dofs(net);
  if (flags.all && modes && flags.states != "kernel") return dense_density(*modes, flags.bins);
  if (flags.states == "dense" || (flags.states == "auto" && rows <= dense_density_rows)) {
    require_dense(flags, rows);
    return dense_density(all_modes(net, false), flags.bins);
  }
  Progress progress("density of states", 1, "");
  KernelOptions options = flags.kernel;
  options.progress = [&](double share) { progress.update(share); };
  return kernel_density(net, flags.bins, options);
}

Table mode_table(const ModesReport& r) {
  Table t({{"mode"},
           {"frequency", "", "Hz", 8},
           {"participation", "participation ratio", "-", 3},
           {"rotation", "rotation share", "-", 3},
           {"residual", "", "-", 2}});
  std::int64_t number = 0;
  for (const auto& m : r.modes->modes)
    t.add({++number, m.frequency(), m.participation, m.rotation, m.residual / m.square});
  return t;
}

Table density_table(const Density& d) {
  Table t({{"from", "", "Hz"}, {"to", "", "Hz"}, {"modes", "", "-", 6}, {"share", "share of all", "-", 4}});
  for (std::size_t k = 0; k < d.modes.size(); ++k) t.add({d.edge[k], d.edge[k + 1], d.modes[k], d.modes[k] / d.total});
  return t;
}

std::string text_of(const ModesReport& r) {
  std::string out = fmt::format("{}{}\n", r.name, r.title.empty() ? "" : ": " + r.title);
  const auto line = [&](const char* key, const std::string& value) { out += fmt::format("  {:<24}{}\n", key, value); };
  line("particles", fmt::format("{}, {} contacts", r.particles, r.contacts));
  if (r.modes) {
    line("modes", fmt::format("{} of {}, by {}", r.modes->modes.size(), r.modes->total, r.modes->method));
    if (r.modes->complete)
      line("counted by inertia", *r.modes->complete ? "none was missed" : "SOME WERE MISSED: ask for more");
    if (r.modes->zero)
      line("without stiffness", fmt::format("{} motions: translations, rattlers, free rotations", *r.modes->zero));
    out += "\n" + mode_table(r).text();
  }
  if (r.density) {
    const auto& d = *r.density;
    line("density of states", fmt::format("{} modes up to {:.8g} Hz, by {}", d.total, d.highest, d.method));
    if (d.vectors > 0)
      line("", fmt::format("{} moments of {} random vectors, standard error {:.2g} % of the modes", d.moments,
                           d.vectors, 100 * d.error));
    out += "\n" + density_table(d).text();
  }
  return out + fmt::format("\n{}\n", duration_text(r.elapsed));
}

nlohmann::json json_of(const ModesReport& r) {
  nlohmann::json j{{"input", r.name},
                   {"title", r.title},
                   {"particles", r.particles},
                   {"contacts", r.contacts},
                   {"elapsed_s", r.elapsed}};
  if (r.modes) {
    const auto& m = *r.modes;
    j["modes"] = mode_table(r).json();
    j["degrees_of_freedom"] = m.total;
    j["without_stiffness"] = m.zero ? nlohmann::json(*m.zero) : nlohmann::json(nullptr);
    j["method"] = m.method;
    j["complete"] = m.complete ? nlohmann::json(*m.complete) : nlohmann::json(nullptr);
  }
  if (r.density) {
    const auto& d = *r.density;
    j["density"] = {{"edges_Hz", d.edge},      {"modes", d.modes},          {"total", d.total},
                    {"highest_Hz", d.highest}, {"standard_error", d.error}, {"vectors", d.vectors},
                    {"moments", d.moments},    {"method", d.method}};
  }
  return j;
}

/// u = M^−½x, as long as a mean radius where it is longest.
void write_shapes(const ModesReport& r, const Network& net, const State& state, const std::string& folder) {
  std::filesystem::create_directories(folder);
  const auto components = active_components(net);
  double mean_radius = 0;
  for (const double radius : net.radius) mean_radius += radius / static_cast<double>(net.size());
  for (std::size_t m = 0; m < r.modes->modes.size(); ++m) {
    GrainField displacement{"displacement", 3, std::vector<double>(3 * net.size())};
    GrainField rotation{"rotation", 3, std::vector<double>(3 * net.size())}, energy{"energy_share", 1, {}};
    Eigen::Index row = 0;
    double longest = 0;
    for (std::size_t g = 0; g < net.size(); ++g) {
      double share = 0;
      for (const int c : components) {
        const double x = r.modes->shapes(row++, static_cast<Eigen::Index>(m));
        const auto at = 3 * g + static_cast<std::size_t>(c % 3);
        share += x * x;
        if (c < 3) longest = std::max(longest, std::abs(displacement.data[at] = x * std::sqrt(net.inverse_mass[g])));
        if (c < 3) continue;
        rotation.data[at] = x * std::sqrt(net.inverse_inertia[g]);
        longest = std::max(longest, std::abs(rotation.data[at] * net.radius[g]));
      }
      energy.data.push_back(share);
    }
    for (auto* field : {&displacement, &rotation})
      for (double& x : field->data) x *= mean_radius / longest;
    const std::array fields{displacement, rotation, energy};
    write_vtp((std::filesystem::path(folder) / fmt::format("mode_{:04d}.vtp", m + 1)).string(), state, fields);
  }
}

void write_tables(const ModesReport& r, const std::string& path) {
  Hdf5Writer file(path, path);
  if (r.modes && !r.modes->modes.empty()) {
    std::vector<double> frequency, participation, rotation;
    for (const auto& m : r.modes->modes) {
      frequency.push_back(m.frequency()), participation.push_back(m.participation), rotation.push_back(m.rotation);
    }
    const auto n = frequency.size();
    const auto& x = r.modes->shapes;
    file.write("modes/frequency", "Hz", {n}, frequency);
    file.write("modes/participation", "-", {n}, participation);
    file.write("modes/rotation", "-", {n}, rotation);
    file.write("modes/shape", "kg^1/2 m", {n, static_cast<unsigned long long>(x.rows())},
               std::vector<double>(x.data(), x.data() + x.size()));
  }
  if (r.density) {
    file.write("density/edges", "Hz", {r.density->edge.size()}, r.density->edge);
    file.write("density/modes", "-", {r.density->modes.size()}, r.density->modes);
  }
  file.close();
}

std::string title_of(const ModesReport& r) { return r.title.empty() ? r.name : r.title; }

Figure mode_figure(const ModesReport& r) {
  Figure figure;
  figure.title = title_of(r);
  figure.subtitle = fmt::format("{} modes of {} grains", r.modes->modes.size(), r.particles);
  figure.x = {.title = "frequency [kHz]"};
  figure.y = {.title = "participation ratio [-]", .low = 0};
  figure.shades = Shades{.title = "share of rotation in the kinetic energy [-]",
                         .colours = {{0.05, 0.20, 0.45}, {0.45, 0.40, 0.55}, {0.95, 0.62, 0.15}}};
  for (const auto& m : r.modes->modes) {
    figure.shaded.x.push_back(1e-3 * m.frequency()), figure.shaded.y.push_back(m.participation);
    figure.shaded.value.push_back(m.rotation);
  }
  return figure;
}

Figure density_figure(const ModesReport& r) {
  const Density& d = *r.density;
  Figure figure;
  figure.title = title_of(r);
  figure.subtitle = fmt::format("{} modes of {} grains, by {}", d.total, r.particles, d.method);
  figure.x = {.title = "frequency [kHz]", .low = 0};
  figure.y = {.title = "modes per kHz, over all modes [1/kHz]", .low = 0};
  Series steps;
  for (std::size_t k = 0; k < d.modes.size(); ++k)
    for (const double edge : {d.edge[k], d.edge[k + 1]}) {
      steps.x.push_back(1e-3 * edge);
      steps.y.push_back(1e3 * d.modes[k] / (d.total * (d.edge[k + 1] - d.edge[k])));
    }
  figure.series.push_back(steps);
  figure.references.push_back({.from = 1e-3 * d.highest, .label = "highest mode"});
  return figure;
}

int modes_command(ModesFlags flags) {
  check_figure(flags.figure);
  if (!flags.wants_modes() && flags.states.empty()) flags.lowest = 20;
  if (!flags.between.empty() && !(flags.between[0] < flags.between[1]))
    throw InputError("--between: the first frequency must be below the second");
  if (!flags.shapes.empty() && !flags.wants_modes())
    throw InputError("--shapes: needs modes; ask for --lowest, --highest, --between or --all");
  const Snapshot work = load_packing(flags.packing);
  const auto begin = std::chrono::steady_clock::now();
  const Network net = linearise(work.scene, work.state);
  ModesReport r;
  r.name = flags.packing.input, r.title = work.scene.title;
  r.particles = net.size(), r.contacts = net.contacts();
  if (flags.wants_modes()) r.modes = find_modes(flags, net);
  if (!flags.states.empty()) r.density = find_density(flags, net, r.modes);
  r.elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (flags.packing.json)
    fmt::print("{}\n", json_of(r).dump(2));
  else
    fmt::print("{}", text_of(r));
  if (!flags.tables.empty()) write_tables(r, flags.tables);
  if (!flags.shapes.empty()) write_shapes(r, net, work.state, flags.shapes);
  if (!flags.figure.empty()) save_figure(r.density ? density_figure(r) : mode_figure(r), flags.figure);
  return 0;
}

}  // namespace

void add_waves_modes(CLI::App& waves, Action& action) {
  auto* sub = waves.add_subcommand("modes", "vibration modes of a packing and their density");
  auto f = std::make_shared<ModesFlags>();
  add_packing_options(*sub, f->packing);
  auto* which = sub->add_option_group("modes", "which modes (default: the 20 slowest)");
  which->add_option("--lowest", f->lowest, "so many of the slowest")->check(CLI::Range(1, 100000));
  which->add_option("--highest", f->highest, "so many of the fastest")->check(CLI::Range(1, 100000));
  which->add_option("--between", f->between, "all between two frequencies [Hz]")
      ->expected(2)
      ->check(finite_option)
      ->check(CLI::NonNegativeNumber);
  which->add_flag("--all", f->all, "every one (dense: some thousand degrees of freedom)");
  which->require_option(0, 1);
  sub->add_option("--states", f->states,
                  "density of states: from all modes (dense), by kernel polynomials (kernel), or by what fits the size "
                  "(auto)")
      ->check(CLI::IsMember({"auto", "dense", "kernel"}));
  sub->add_option("--bins", f->bins, "intervals of the density")->check(CLI::Range(1, 100000));
  sub->add_option("--moments", f->kernel.moments, "Chebyshev moments (default: 40 an interval)")
      ->check(CLI::Range(2, 10000000));
  sub->add_option("--vectors", f->kernel.vectors, "random vectors (default: by the size)")
      ->check(CLI::Range(1, 1000000));
  sub->add_option("--figure", f->figure, "draw the density, or the modes if there is none (.svg, .png or .pdf)");
  sub->add_option("--tables", f->tables, "write modes, shapes and density (HDF5)");
  sub->add_option("--shapes", f->shapes, "folder for a .vtp file a mode, for ParaView");
  sub->callback([f, &action] { action = [f] { return modes_command(*f); }; });
}

}  // namespace eg
