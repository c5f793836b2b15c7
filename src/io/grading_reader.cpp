#include "io/grading_reader.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "state/grading_preset.hpp"

namespace eg {
namespace {

constexpr auto required = Need::required;

void check_passing(const TomlReader& t, const Grading& g) {
  if (g.passing.size() < 2) throw t.error("passing", "must hold at least two rows [diameter, passing]");
  for (std::size_t k = 0; k < g.passing.size(); ++k) {
    const auto [d, p] = g.passing[k];
    if (d <= 0) throw t.error("passing", fmt::format("has the diameter {} in row {}, which must be > 0", d, k + 1));
    if (k > 0 && (d <= g.passing[k - 1][0] || p < g.passing[k - 1][1]))
      throw t.error("passing", fmt::format("must ascend in diameter and in passing, but row {} does not", k + 1));
  }
  if (g.passing.front()[1] != 0 || g.passing.back()[1] != 1)
    throw t.error("passing", "must run from passing 0 to passing 1", "write fractions of the mass, not per cent");
}

/// The ways to give sizes, each by its keys.
enum class Way { single, uniform, table, gap };

Way way_of(const TomlReader& t) {
  struct Keys {
    Way way;
    std::vector<std::string_view> keys;
  };
  static const std::vector<Keys> ways{{Way::single, {"radius"}},
                                      {Way::uniform, {"min_radius", "max_radius"}},
                                      {Way::table, {"passing"}},
                                      {Way::gap, {"coarse", "fines", "fines_content"}}};
  constexpr std::string_view remedy =
      "give radius, or min_radius and max_radius, or passing, or coarse, fines and fines_content";
  for (const auto& w : ways)
    for (const auto key : w.keys) t.has(key);
  t.finish();
  std::optional<Way> found;
  for (const auto& w : ways)
    if (const auto key = std::ranges::find_if(w.keys, [&](auto k) { return t.has(k); }); key != w.keys.end()) {
      if (found) throw t.error(*key, "is not the only size given", remedy);
      found = w.way;
    }
  if (!found) throw t.error("", "holds no sizes", remedy);
  return *found;
}

/// Two ranges of diameters, by mass uniform in each, as a table.
void read_gap(const TomlReader& t, Grading& g) {
  std::array<double, 2> coarse{}, fines{};
  double content = 0;
  t.numbers("coarse", coarse, positive, required);
  t.numbers("fines", fines, positive, required);
  t.number("fines_content", content, open(0, 1), required);
  for (const auto& [key, range] : {std::pair{"coarse", coarse}, std::pair{"fines", fines}})
    if (!(range[0] < range[1]))
      throw t.error(key, "must be [smallest, largest] diameter", "for one size give a narrow range");
  if (!(fines[1] < coarse[0])) throw t.error("fines", "must all be smaller than the coarse grains");
  g.gap = true;
  g.passing = {{fines[0], 0}, {fines[1], content}, {coarse[0], content}, {coarse[1], 1}};
}

}  // namespace

Grading read_grading(const TomlReader& specimen) {
  if (specimen.is_text("grading")) {
    std::string name;
    specimen.choice("grading", name, grading_preset_names());
    return *grading_preset(name);
  }
  const auto t = *specimen.table("grading", required);
  Grading g;
  switch (way_of(t)) {
    case Way::single:
      t.number("radius", g.min_radius, positive);
      g.max_radius = g.min_radius;
      break;
    case Way::uniform:
      g.kind = Grading::Kind::uniform;
      t.number("min_radius", g.min_radius, positive, required);
      t.number("max_radius", g.max_radius, positive, required);
      if (g.max_radius < g.min_radius) throw t.error("max_radius", "must not be below min_radius");
      break;
    case Way::table:
      g.kind = Grading::Kind::table;
      t.pairs("passing", g.passing);
      check_passing(t, g);
      break;
    case Way::gap:
      g.kind = Grading::Kind::table;
      read_gap(t, g);
      break;
  }
  if (g.kind == Grading::Kind::table) g.min_radius = g.passing.front()[0] / 2, g.max_radius = g.passing.back()[0] / 2;
  t.finish();
  return g;
}

}  // namespace eg
