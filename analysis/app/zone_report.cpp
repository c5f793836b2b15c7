#include "app/zone_report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "app/number_words.hpp"
#include "base/error.hpp"
#include "report/table.hpp"

namespace eg {
namespace {

using Shape = ZoneGrid::Shape;
using Parts = std::vector<std::string>;

Parts split(const std::string& text, char at) {
  Parts parts{""};
  for (const char c : text)
    if (c == at)
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

/// What goes wrong with an option is one line that names it.
struct Option {
  const std::string& input;
  std::string text;  ///< "--zones radial:0"

  InputError error(const std::string& rule, const std::string& remedy) const {
    return input_error(input, 0, text, rule, remedy);
  }
  double number(const std::string& word) const {
    const double value = number_of(word);
    if (std::isnan(value))
      throw error(fmt::format("has \"{}\" where a number belongs", word), "write numbers in m without a unit");
    return value;
  }
};

/// Names of the three coordinates of a shape, as --zones has them.
std::array<std::string, 3> coordinates(Shape shape) {
  return shape == Shape::box ? std::array<std::string, 3>{"x", "y", "z"}
                             : std::array<std::string, 3>{"radial", "sector", "height"};
}

/// The same in tables and JSON.
std::array<std::string, 3> bounds_of(Shape shape) {
  return shape == Shape::box ? coordinates(shape) : std::array<std::string, 3>{"radius", "angle", "height"};
}

constexpr const char* zones_remedy =
    "name coordinates and counts: radial:9 or height:5 or radial:4,sector:8,height:3 (cylinder), x:4,z:3 (box)";

/// Ends of a container, checked.
std::vector<double> ends(const Option& option, double from, double to) {
  if (!(from < to)) throw option.error("has an end that is not above its beginning", "give FROM,TO in ascending order");
  return {from, to};
}

ZoneGrid container_of(const State& state, const ZoneFlags& flags, Shape shape, const std::string& input) {
  const int axis = flags.axis == "x" ? 0 : flags.axis == "y" ? 1 : 2;
  const Option option{input, "--container " + flags.container};
  const bool solid = state.dimension == 3;
  if (!solid && axis != 2) throw input_error(input, 0, "--zone-axis", "is for 3D", "leave it out");
  ZoneGrid grid = whole_specimen(state, shape, axis);
  if (flags.container.empty()) return grid;
  const auto words = split(flags.container, ':');
  const std::string name = shape == Shape::box ? "box" : "cylinder";
  const std::string form = shape == Shape::box ? (solid ? "box:X0,X1,Y0,Y1,Z0,Z1" : "box:X0,X1,Y0,Y1")
                                               : (solid ? "cylinder:X,Y,R,BOTTOM,TOP" : "cylinder:X,Y,R");
  if (words.size() != 2 || words[0] != name)
    throw option.error(fmt::format("is not the {} that --zones cuts", name), "write " + form);
  std::vector<double> v;
  for (const auto& word : split(words[1], ',')) v.push_back(option.number(word));
  if (v.size() != split(form, ',').size()) throw option.error("has the wrong number of numbers", "write " + form);
  if (shape == Shape::box) {
    for (std::size_t k = 0; 2 * k < v.size(); ++k) grid.edges[k] = ends(option, v[2 * k], v[2 * k + 1]);
    return grid;
  }
  grid.centre[(axis + 1) % 3] = v[0], grid.centre[(axis + 2) % 3] = v[1];
  if (!(v[2] > 0)) throw option.error("has a radius that is not above 0", "write " + form);
  grid.edges[0] = {0, v[2]};
  if (solid) grid.edges[2] = ends(option, v[3], v[4]);
  return grid;
}

/// Cuts one coordinate: into a number of equal parts, or at given places.
void cut(const Option& option, const std::string& parts, std::vector<double>& edges) {
  const auto words = split(parts, '/');
  if (words.size() == 1) {
    const double count = option.number(parts), from = edges.front(), to = edges.back();
    if (!(count >= 1 && count <= 1e6) || count != std::floor(count))
      throw option.error(fmt::format("asks for {} parts", parts),
                         "give a whole number of 1 or more, or places 0/0.01/0.02");
    edges.clear();
    for (int k = 0; k <= static_cast<int>(count); ++k) edges.push_back(from + (to - from) * k / count);
    edges.back() = to;
    return;
  }
  edges.clear();
  for (const auto& word : words) edges.push_back(option.number(word));
  if (!std::ranges::is_sorted(edges, std::ranges::less_equal{}))
    throw option.error("has places that do not ascend", "write them from low to high: 0/0.01/0.02");
}

ZoneGrid grid_of(const State& state, const ZoneFlags& flags, const std::string& zones, const std::string& input) {
  const Option option{input, "--zones " + zones};
  std::vector<Parts> cuts;
  for (const auto& word : split(zones, ',')) cuts.push_back(split(word, ':'));
  const auto first = cuts[0][0];
  const Shape shape = std::ranges::count(coordinates(Shape::box), first) ? Shape::box : Shape::cylinder;
  const auto names = coordinates(shape);
  ZoneGrid grid = container_of(state, flags, shape, input);
  std::array<bool, 3> done{};
  for (const auto& c : cuts) {
    const auto place = static_cast<std::size_t>(std::ranges::find(names, c[0]) - names.begin());
    if (place == 3 || c.size() != 2 || c[1].empty() || (place == 2 && state.dimension == 2))
      throw option.error(fmt::format("makes no zones of a {}", shape == Shape::box ? "box" : "cylinder"), zones_remedy);
    if (std::exchange(done[place], true)) throw option.error(fmt::format("cuts {} twice", c[0]), zones_remedy);
    cut(option, c[1], grid.edges[place]);
  }
  if (shape == Shape::cylinder &&
      (grid.edges[0].front() < 0 || grid.edges[1].back() - grid.edges[1].front() > 2 * std::numbers::pi * (1 + 1e-12)))
    throw option.error("leaves the cylinder", "radii are 0 or more and sectors [rad] make one turn at most");
  return grid;
}

std::string cylinder_axes(int axis) { return fmt::format("{}, {}", "xyz"[(axis + 1) % 3], "xyz"[(axis + 2) % 3]); }

/// "cylinder around (x, y) = (0, 0) m along z, radius 0 … 0.0508 m, height 0 … 0.028 m"
std::string container_text(const ZoneGrid& g, int dimension) {
  const auto& e = g.edges;
  const auto from_to = [&](std::size_t k) { return fmt::format("{:.6g} … {:.6g} m", e[k].front(), e[k].back()); };
  const bool solid = dimension == 3;
  if (g.shape == Shape::box)
    return fmt::format("box x {}, y {}{}", from_to(0), from_to(1), solid ? ", z " + from_to(2) : "");
  return fmt::format("cylinder around ({}) = ({:.6g}, {:.6g}) m, radius {}{}", cylinder_axes(g.axis),
                     g.centre[(g.axis + 1) % 3], g.centre[(g.axis + 2) % 3], from_to(0),
                     solid ? ", height " + from_to(2) : "");
}

Table table_of(const ZoneReport& r, int dimension) {
  const bool box = r.grid.shape == Shape::box;
  const auto names = bounds_of(r.grid.shape);
  std::vector<std::size_t> shown;
  for (std::size_t k = 0; k < static_cast<std::size_t>(dimension); ++k)
    if (r.grid.edges[k].size() > 2) shown.push_back(k);
  const bool solid = dimension == 3;
  std::vector<Column> columns{{"zone"}};
  for (const auto k : shown)
    for (const char* end : {"from", "to"})
      columns.push_back({names[k] + "_" + end, names[k] + " " + end, !box && k == 1 ? "rad" : "m"});
  columns.insert(columns.end(), {{"particles"},
                                 {"volume", "", solid ? "m3" : "m2"},
                                 {"solid_volume", "of grains", solid ? "m3" : "m2"},
                                 {"solid_fraction", "solid fraction", "-"},
                                 {"void_ratio", "void ratio", "-"},
                                 {"void_ratio_over_whole", "over whole", "-"}});
  Table table(columns);
  for (std::int64_t number = 0; const auto& zone : r.table.zones) {
    std::vector<Value> row{++number};
    for (const auto k : shown) row.insert(row.end(), {zone.bounds[k].low, zone.bounds[k].high});
    row.insert(row.end(), {static_cast<std::int64_t>(zone.grains), zone.volume, zone.solid, zone.solid_fraction(),
                           zone.void_ratio(), zone.void_ratio() / r.table.whole.void_ratio()});
    table.add(row);
  }
  return table;
}

}  // namespace

void add_zone_options(CLI::App& command, ZoneFlags& flags) {
  command
      .add_option("--zones", flags.zones,
                  "void ratios in zones: radial:9 | height:5 | radial:4,sector:8,height:3 | x:4,z:3; repeatable")
      ->type_size(1)
      ->allow_extra_args(false)
      ->type_name("ZONES");
  command.add_option(
      "--container", flags.container,
      "what --zones cuts: cylinder:X,Y,R,BOTTOM,TOP or box:X0,X1,Y0,Y1,Z0,Z1 [m] (default: the specimen)");
  command.add_option("--zone-axis", flags.axis, "axis of the cylinder: x, y or z (default)")
      ->check(CLI::IsMember({"x", "y", "z"}));
}

std::vector<ZoneReport> zone_reports(const State& state, const ZoneFlags& flags, const std::string& input) {
  if (flags.zones.empty() && !flags.container.empty())
    throw input_error(input, 0, "--container", "is read with --zones only", zones_remedy);
  std::vector<ZoneReport> reports;
  for (const auto& zones : flags.zones) {
    const ZoneGrid grid = grid_of(state, flags, zones, input);
    reports.push_back({zones, grid, measure_zones(state, grid)});
  }
  return reports;
}

std::string text_of(const ZoneReport& r, int dimension) {
  const auto& whole = r.table.whole;
  return fmt::format(
      "\nzones {}: {}\n{}all zones: void ratio {:.4f}, solid fraction {:.4f}, particles {}; variance of the void ratio "
      "{:.3g}\n",
      r.zones, container_text(r.grid, dimension), table_of(r, dimension).text(), whole.void_ratio(),
      whole.solid_fraction(), whole.grains, r.table.variance);
}

nlohmann::json json_of(const ZoneReport& r, int dimension) {
  const auto& whole = r.table.whole;
  const bool box = r.grid.shape == Shape::box;
  nlohmann::json container{{"shape", box ? "box" : "cylinder"}};
  const auto names = bounds_of(r.grid.shape);
  for (std::size_t k = 0; k < static_cast<std::size_t>(dimension); ++k)
    container[names[k]] = {r.grid.edges[k].front(), r.grid.edges[k].back()};
  if (!box) {
    container["axis"] = std::string(1, "xyz"[r.grid.axis]);
    container["centre"] = {r.grid.centre[(r.grid.axis + 1) % 3], r.grid.centre[(r.grid.axis + 2) % 3]};
  }
  return {{"zones", r.zones},
          {"container", container},
          {"volume", whole.volume},
          {"solid_volume", whole.solid},
          {"particles", whole.grains},
          {"solid_fraction", whole.solid_fraction()},
          {"void_ratio", whole.void_ratio()},
          {"variance", r.table.variance},
          {"table", table_of(r, dimension).json()}};
}

}  // namespace eg
