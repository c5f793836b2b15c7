#include "app/slice_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/number_words.hpp"
#include "app/packing_input.hpp"
#include "base/error.hpp"
#include "measure/volume.hpp"
#include "measure/zone_grid.hpp"
#include "report/slice_chart.hpp"

namespace eg {
namespace {

/// A slab across one axis (2D: everything), seen with `right` and `up` on the page.
struct Slice {
  int axis = 2, right = 0, up = 1;
  Extent through{};
  std::array<Extent, 3> extents{};

  bool holds(const Vec3& x) const { return through.holds(x[axis]); }
  std::string where() const {
    return std::isfinite(through.low) ? fmt::format("{:.4g} m ≤ {} < {:.4g} m", through.low, "xyz"[axis], through.high)
                                      : "";
  }
};

Slice slice_of(const SliceFlags& flags, const State& state, const std::string& input) {
  Slice slice{.extents = specimen_extents(state)};
  const auto& words = flags.slice;
  if (state.dimension == 2) {
    if (!words.empty())
      throw input_error(input, 0, "--slice", "is for 3D", "leave it out: a 2D packing is drawn whole");
    return slice;
  }
  const auto error = [&] {
    return input_error(input, 0, "--slice", "takes an axis, a position and a thickness",
                       "write for example y,0.02,0.005 [m], or y alone for the middle");
  };
  const std::string name = words.empty() ? "y" : words[0];
  if ((words.size() > 1 && words.size() != 3) || (name != "x" && name != "y" && name != "z")) throw error();
  slice.axis = name == "x" ? 0 : name == "y" ? 1 : 2;
  slice.right = slice.axis == 0 ? 1 : 0, slice.up = slice.axis == 2 ? 1 : 2;
  const auto number = [&](const std::string& word) {
    const double value = number_of(word);
    if (std::isnan(value)) throw error();
    return value;
  };
  const Extent& across = slice.extents[static_cast<std::size_t>(slice.axis)];
  const double position = words.size() == 3 ? number(words[1]) : 0.5 * (across.low + across.high);
  const double thickness = words.size() == 3 ? number(words[2]) : 2 * size_statistics(state).d50;
  if (!(thickness > 0)) throw error();
  slice.through = {position - thickness / 2, position + thickness / 2};
  return slice;
}

SliceChart chart_of(const Slice& slice, const State& state) {
  SliceChart chart;
  const auto& x = slice.extents[static_cast<std::size_t>(slice.right)];
  const auto& y = slice.extents[static_cast<std::size_t>(slice.up)];
  chart.x = fmt::format("{} [m]", "xyz"[slice.right]), chart.y = fmt::format("{} [m]", "xyz"[slice.up]);
  const double room = 0.02 * std::max(x.length(), y.length());
  chart.x_low = x.low - room, chart.x_high = x.high + room, chart.y_low = y.low - room, chart.y_high = y.high + room;
  for (const Quad& grain : state.grains.position)
    if (slice.holds(grain.vec())) chart.disks.push_back({grain.vec()[slice.right], grain.vec()[slice.up], grain.w});
  return chart;
}

SliceChart force_chart(const Slice& slice, const State& state, std::span<const ContactPoint> contacts) {
  SliceChart chart = chart_of(slice, state);
  const ForceChains chains = force_chains(state, contacts);
  double most = 0;
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const auto& c = contacts[k];
    const Vec3 from = state.grains.position[c.i].vec(), to = from + c.branch;
    if (!slice.holds(from + 0.5 * c.branch)) continue;
    chart.lines.push_back({from[slice.right], from[slice.up], to[slice.right], to[slice.up], c.normal.force,
                           chains.link[k] != ForceChains::none});
    most = std::max(most, c.normal.force);
  }
  chart.note = fmt::format("lines: normal forces, up to {:.3g} N; red: force chains", most);
  return chart;
}

/// Values of grains in the later state, as colours from 0 to their 98th percentile.
void shade(SliceChart& chart, const Slice& slice, const State& state, const GrainField& field, const char* title) {
  std::vector<double> shown;
  for (std::size_t i = 0, k = 0; i < state.grains.size(); ++i)
    if (slice.holds(state.grains.position[i].vec())) {
      chart.disks[k++].value = field.data[i];
      if (std::isfinite(field.data[i])) shown.push_back(field.data[i]);
    }
  std::ranges::sort(shown);
  const double high = shown.empty() ? 1 : shown[shown.size() * 98 / 100];
  chart.shades = Shades{.title = title, .low = 0, .high = high > 0 ? high : 1};
}

SliceChart shear_chart(const Slice& slice, const State& state, const Since& since) {
  SliceChart chart = chart_of(slice, state);
  for (const auto& field : since_fields(since, state.grains.size()))
    if (field.name == "shear_strain") shade(chart, slice, state, field, "local shear strain [-]");
  return chart;
}

SliceChart displacement_chart(const Slice& slice, const State& state, const Since& since) {
  SliceChart chart = chart_of(slice, state);
  std::vector<double> sizes;
  const auto& m = since.motion;
  const auto shown = [&](std::size_t i) { return slice.holds(state.grains.position[m.now[i]].vec()); };
  for (std::size_t i = 0; i < m.size(); ++i)
    if (shown(i)) sizes.push_back(std::hypot(m.displacement[i][slice.right], m.displacement[i][slice.up]));
  std::ranges::sort(sizes);
  const double typical = sizes.empty() ? 0 : sizes[sizes.size() * 95 / 100];
  const double length = 0.06 * std::max(chart.x_high - chart.x_low, chart.y_high - chart.y_low);
  const double times = typical > 0 ? length / typical : 1;
  for (std::size_t i = 0; i < m.size(); ++i) {
    if (!shown(i)) continue;
    const Vec3 to = state.grains.position[m.now[i]].vec(), by = times * m.displacement[i];
    chart.arrows.push_back(
        {to[slice.right] - by[slice.right], to[slice.up] - by[slice.up], by[slice.right], by[slice.up]});
  }
  chart.note = fmt::format("arrows: displacements times {:.3g}, ending where the grains are now", times);
  return chart;
}

/// Cells of some edge that fill a stretch, at least one.
std::vector<double> cells_along(const Extent& e, double edge) {
  if (e.length() / edge > 1e6)
    throw InputError(fmt::format(
        "eigengrain measure: --map-cell {:.3g} cuts {:.3g} m into more than a million cells; take larger ones", edge,
        e.length()));
  const int count = std::max(1, static_cast<int>(std::lround(e.length() / edge)));
  std::vector<double> places;
  for (int k = 0; k <= count; ++k) places.push_back(e.low + e.length() * k / count);
  return places;
}

double cell_of(const SliceFlags& flags, const State& state) {
  return flags.cell > 0 ? flags.cell : 2 * size_statistics(state).d50;
}

Figure void_figure(const Slice& slice, const State& state, double cell) {
  ZoneGrid grid;
  for (const int k : {slice.right, slice.up}) {
    const auto axis = static_cast<std::size_t>(k);
    grid.edges[axis] = cells_along(slice.extents[axis], cell);
  }
  grid.edges[static_cast<std::size_t>(slice.axis)] = {slice.through.low, slice.through.high};
  const ZoneTable table = measure_zones(state, grid);
  const auto &x = grid.edges[static_cast<std::size_t>(slice.right)],
             &y = grid.edges[static_cast<std::size_t>(slice.up)];
  Figure f;
  f.subtitle = slice.where();
  f.x = {.title = fmt::format("{} [m]", "xyz"[slice.right]), .low = x.front(), .high = x.back()};
  f.y = {.title = fmt::format("{} [m]", "xyz"[slice.up]), .low = y.front(), .high = y.back()};
  f.map = {x.front(), x.back(), y.front(), y.back(), x.size() - 1, y.size() - 1, {}};
  double low = INFINITY, high = 0;
  for (std::size_t row = 0; row < f.map.rows; ++row)
    for (std::size_t column = 0; column < f.map.columns; ++column) {
      // the slice is one cell thick, and `right` comes before `up` in the order of the zones
      const double e = table.zones[column * f.map.rows + row].void_ratio();
      f.map.value.push_back(std::min(e, std::numeric_limits<double>::max()));  // an empty cell is looser than any
      if (std::isfinite(e)) low = std::min(low, e), high = std::max(high, e);
    }
  f.shades = Shades{.title = "void ratio [-]", .low = low, .high = std::min(high, 2 * table.whole.void_ratio())};
  const double ratio = (y.back() - y.front()) / (x.back() - x.front());
  f.width = ratio > 1 ? 150 + 400 / ratio : 560, f.height = ratio > 1 ? 490 : 90 + 410 * ratio;
  return f;
}

}  // namespace

void add_slice_options(CLI::App& command, SliceFlags& flags) {
  command
      .add_option("--slice", flags.slice,
                  "slab of the figures of slices: AXIS,POSITION,THICKNESS [m], or AXIS (default: y, its middle, 2 d50)")
      ->delimiter(',');
  command.add_option("--void-map", flags.void_map, "write local void ratios, cell by cell, for ParaView (.vti)");
  command.add_option("--map-cell", flags.cell, "edge of the cells of local void ratios [m] (default: 2 d50)")
      ->check(positive_option);
}

const std::vector<std::string>& slice_figures() {
  static const std::vector<std::string> names{"force-slice", "void-slice", "shear-slice", "displacement-slice"};
  return names;
}

void draw_slice(const std::string& kind, const SliceFlags& flags, const Snapshot& packing, const std::string& name,
                std::span<const ContactPoint> contacts, const Since* since, const std::string& path) {
  const State& state = packing.state;
  const Slice slice = slice_of(flags, state, name);
  const std::string title = packing.scene.title.empty() ? name : packing.scene.title;
  if (kind == "void-slice") {
    Figure figure = void_figure(slice, state, cell_of(flags, state));
    figure.title = title;
    return save_figure(figure, path);
  }
  if (kind != "force-slice" && !since)
    throw input_error(name, 0, "--plot " + kind, "compares two snapshots", "name the earlier one by --since");
  SliceChart chart = kind == "force-slice"   ? force_chart(slice, state, contacts)
                     : kind == "shear-slice" ? shear_chart(slice, state, *since)
                                             : displacement_chart(slice, state, *since);
  chart.title = title, chart.subtitle = slice.where();
  write_slice(chart, path);
  fmt::print(stderr, "figure: {}\n", path);
}

void write_void_map(const SliceFlags& flags, const State& state) {
  ZoneGrid grid;
  const auto extents = specimen_extents(state);
  for (std::size_t k = 0; k < static_cast<std::size_t>(state.dimension); ++k)
    grid.edges[k] = cells_along(extents[k], cell_of(flags, state));
  if (state.dimension == 2) grid.edges[2] = {0, 1};
  write_vti(flags.void_map, grid, measure_zones(state, grid));
  fmt::print(stderr, "void ratios: {}\n", flags.void_map);
}

}  // namespace eg
