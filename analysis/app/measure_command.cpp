// eigengrain measure SNAPSHOT|SCENE|PACKING: stress, fabric, forces, sizes of a packing.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "app/commands.hpp"
#include "app/measure_figure.hpp"
#include "app/measure_report.hpp"
#include "app/number_words.hpp"
#include "app/packing_input.hpp"
#include "app/since_report.hpp"
#include "app/slice_figure.hpp"
#include "app/zone_report.hpp"
#include "base/error.hpp"
#include "io/vtk.hpp"

namespace eg {
namespace {

struct MeasureFlags {
  PackingFlags packing;
  std::string figure, plot = "rose", chains;
  std::vector<double> splits;
  std::vector<std::vector<double>> spheres;
  ZoneFlags zones;
  SinceFlags since;
  SliceFlags slice;
};

std::vector<MeasureSphere> spheres_of(const MeasureFlags& flags, int dimension) {
  std::vector<MeasureSphere> spheres;
  for (const auto& s : flags.spheres) {
    const auto size = static_cast<std::size_t>(dimension) + 1;
    if (s.size() != size || !(s.back() > 0))
      throw input_error(flags.packing.input, 0, "--sphere",
                        fmt::format("takes {} numbers in {}D, the radius > 0", size, dimension),
                        dimension == 3 ? "give X,Y,Z,RADIUS in m" : "give X,Y,RADIUS in m");
    spheres.push_back({{s[0], s[1], dimension == 3 ? s[2] : 0.0}, s.back()});
  }
  return spheres;
}

/// The comparison with an earlier snapshot, if one is given; its numbers go to the report, its fields to their file.
std::optional<Since> compared(const MeasureFlags& flags, const State& state, std::span<const MeasureSphere> spheres,
                              MeasureReport& report) {
  const SinceFlags& f = flags.since;
  if (f.snapshot.empty()) {
    if (!f.gauges.empty() || !f.fields.empty())
      throw input_error(flags.packing.input, 0, f.gauges.empty() ? "--fields" : "--gauge", "compares two snapshots",
                        "name the earlier one by --since");
    return std::nullopt;
  }
  Since since = compare(f, state);
  add_since(report, since, f, state, spheres);
  if (!f.fields.empty()) {
    if (const auto folder = std::filesystem::path(f.fields).parent_path(); !folder.empty())
      std::filesystem::create_directories(folder);
    write_vtp(f.fields, state, since_fields(since, state.grains.size()));
    fmt::print(stderr, "displacements and strains: {}\n", f.fields);
  }
  return since;
}

void print(const MeasureReport& report, std::span<const ZoneReport> zones, bool as_json) {
  if (as_json) {
    auto json = json_of(report);
    for (const auto& zone : zones) json["zones"].push_back(json_of(zone, report.dimension));
    fmt::print("{}\n", json.dump(2));
    return;
  }
  fmt::print("{}", text_of(report));
  for (const auto& zone : zones) fmt::print("{}", text_of(zone, report.dimension));
}

int measure_command(const MeasureFlags& flags) {
  check_figure(flags.figure);
  if (!std::ranges::is_sorted(flags.splits, std::ranges::less_equal{}) ||
      (!flags.splits.empty() && flags.splits[0] <= 0))
    throw input_error(flags.packing.input, 0, "--split", "must be diameters that ascend", "for example 0.15e-3,0.3e-3");
  const Snapshot packing = load_packing(flags.packing);
  const State& state = packing.state;
  const auto contacts = touching_contacts(packing.scene, state);
  const auto spheres = spheres_of(flags, state.dimension);
  auto report = measure_report(packing, flags.packing.input, contacts, flags.splits, spheres);
  const auto since = compared(flags, state, spheres, report);
  print(report, zone_reports(state, flags.zones, flags.packing.input), flags.packing.json);
  if (!flags.figure.empty() && std::ranges::count(slice_figures(), flags.plot))
    draw_slice(flags.plot, flags.slice, packing, flags.packing.input, contacts, since ? &*since : nullptr,
               flags.figure);
  else if (!flags.figure.empty())
    draw_measure(report, flags.plot, flags.figure);
  if (!flags.slice.void_map.empty()) write_void_map(flags.slice, state);
  if (!flags.chains.empty()) {
    write_network_vtp(flags.chains, state, contacts, force_chains(state, contacts));
    fmt::print(stderr, "contacts and force chains: {}\n", flags.chains);
  }
  return 0;
}

}  // namespace

void add_measure_command(CLI::App& app, Action& action) {
  auto* sub = app.add_subcommand("measure", "stress, fabric, forces and sizes of a packing");
  auto flags = std::make_shared<MeasureFlags>();
  add_packing_options(*sub, flags->packing);
  auto* figure =
      sub->add_option("--figure", flags->figure, "draw a figure (.svg, .png or .pdf): the one named by --plot");
  auto figures = measure_figures();
  figures.insert(figures.end(), slice_figures().begin(), slice_figures().end());
  sub->add_option("--plot", flags->plot, "which figure (default: rose)")->check(CLI::IsMember(figures))->needs(figure);
  sub->add_option("--chains", flags->chains, "write contacts and force chains for ParaView (.vtp)");
  sub->add_option("--split", flags->splits, "diameters between size fractions, D1,D2,... [m]")
      ->delimiter(',')
      ->check(finite_option);
  sub->add_option("--sphere", flags->spheres, "measure inside a sphere X,Y,Z,RADIUS (2D: X,Y,RADIUS) [m]; repeatable")
      ->delimiter(',')
      ->check(finite_option);
  add_zone_options(*sub, flags->zones);
  add_since_options(*sub, flags->since);
  add_slice_options(*sub, flags->slice);
  sub->callback([flags, &action] { action = [flags] { return measure_command(*flags); }; });
}

}  // namespace eg
