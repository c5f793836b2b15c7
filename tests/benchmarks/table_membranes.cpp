// Regular packings in membranes against theory, laboratory and the simulations of O'Sullivan et al. (2003, 2004).
// Run by: ./dev validation membranes; writes FOLDER/membranes.json and FOLDER/figures/membranes_*.svg.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "boundary/body_control.hpp"
#include "dynamics/run.hpp"
#include "io/scene_file.hpp"
#include "io/text_file.hpp"
#include "measure/volume.hpp"
#include "report/plot.hpp"
#include "report/table.hpp"
#include "specimen/make_packing.hpp"
#include "specimen/make_state.hpp"
#include "support/program.hpp"
#include "timestep/controller.hpp"

using namespace eg;

namespace {

constexpr double degree = std::numbers::pi / 180;

double friction_angle(double major, double minor) { return std::asin((major - minor) / (major + minor)) / degree; }

/// Axial strain [%] and friction angle [°], row by row of the last stage: of the grains' mean stress, and of the load
/// over the section that is measured from outside.
struct Curve {
  std::vector<double> strain, angle, outer;

  std::size_t at_peak() const { return static_cast<std::size_t>(std::ranges::max_element(angle) - angle.begin()); }
};

Curve run(const std::string& test, const SceneSettings& settings, int seed) {
  SceneSettings all = settings;
  all.push_back(fmt::format("seed={}", seed));
  const Scene scene = read_scene(fmt::format("cases/{}.toml", test), all);
  State state = make_state(scene, make_packing(scene));
  Controller controller(scene);
  Curve curve;
  const auto top = 2 * static_cast<std::size_t>(scene.dimension) - 1;
  const int axis = scene.dimension - 1;
  double height = 0;
  RunObserver observer;
  observer.stage_end = [&](const State& s, const StageSpec&) { height = wall_gap(s, axis).length(); };
  observer.record = [&](const State& s, const RunStatus& status) {
    if (status.stage.name != "shear") return;
    double major = 0, outer = 0;  // of both platens
    for (const std::size_t body : {top, top - 1}) {
      major += body_load(scene, s, drive_of(scene, s, body)).stress() / 2;
      outer += outer_stress(scene, s, body) / 2;
    }
    curve.strain.push_back(-100 * s.bodies[top].moved[axis] / height);
    curve.angle.push_back(friction_angle(major, s.membrane.stress));
    curve.outer.push_back(friction_angle(outer, s.membrane.stress));
  };
  try {
    run_stages(scene, state, controller, observer);
  } catch (const std::exception& e) {  // past the peak a regular packing may fall apart
    fmt::print(stderr, "{} seed {}: {}\n", test, seed, e.what());
  }
  return curve;
}

struct Row {
  std::string test, variant;
  SceneSettings settings;
  int seeds;
  double theory, published;  ///< [°]; NaN: none
};

constexpr double none = not_given;

void add_rods(std::vector<Row>& rows) {
  const std::string test = "hexagonal_biaxial";
  constexpr int seeds = 6;
  const std::string scattered = R"(contact.friction_scatter={per="contact",deviation=0.2555})";
  rows.push_back({test, "equal", {}, 1, 43.29, 41});
  rows.push_back({test, "friction ± 3.0°", {scattered}, seeds, none, 37});
  for (const double s : {0.5, 1.0, 2.0, 3.0, 5.0})
    rows.push_back({test,
                    fmt::format("radii ± {} %", s),
                    {fmt::format("specimen.radius_scatter={}", s / 100)},
                    seeds,
                    none,
                    s == 0.5   ? 45
                    : s == 5.0 ? 25
                               : none});
}

/// Gaps between unequal balls close first: such tests go on longer and are run faster, `cells` of them.
void add_balls(std::vector<Row>& rows, const std::string& test, double theory,
               const std::map<double, double>& published, const std::string& cells) {
  constexpr int seeds = 3;
  for (const double s : {0.0, 0.35, 0.7, 1.2, 1.9, 3.0}) {
    SceneSettings settings{fmt::format("specimen.radius_scatter={}", s / 100)};
    if (s > 0) {
      settings.push_back("stage[2].body.z_high.velocity=[0,0,-4.8e-3]");
      settings.push_back("stage[2].until.displacement=24");
      settings.push_back("specimen.cells=" + cells);
      settings.push_back("stage[2].record.every_displacement=0.1");
    }
    const auto known = published.find(s);
    rows.push_back({test, s == 0 ? "equal" : fmt::format("radii ± {} %", s), settings, seeds, s == 0 ? theory : none,
                    known == published.end() ? none : known->second});
  }
}

std::vector<Row> all_rows() {
  std::vector<Row> rows;
  add_rods(rows);
  add_balls(rows, "fcc_triaxial", 24.60, {{0, 24.4}}, "[5,5,8]");
  add_balls(rows, "rhombic_triaxial", 41.58, {{0, 41.6}}, "[5,3,6]");
  add_balls(rows, "rhombic_plane_strain", none, {{0, 40.0}, {0.7, 37.5}, {1.2, 36.0}, {1.9, 32.6}}, "[5,3,6]");
  return rows;
}

Value value_of(double x) { return std::isnan(x) ? Value{} : Value{x}; }

Table empty_table() {
  return Table({{"test"},
                {"variant"},
                {"seeds"},
                {"mean", "mean peak", "°", 3},
                {"lowest", "lowest", "°", 3},
                {"highest", "highest", "°", 3},
                {"outer", "by outer section", "°", 3},
                {"strain", "at strain", "%", 2},
                {"theory", "theory", "°", 4},
                {"published", "published", "°", 3}});
}

/// Adds a row to the table, and the curve of its first seed to the figure.
void add_row(const Row& row, Table& table, Figure& figure) {
  double mean = 0, outer = 0, strain = 0, lowest = 90, highest = 0;
  for (int seed = 1; seed <= row.seeds; ++seed) {
    const Curve curve = run(row.test, row.settings, seed);
    const std::size_t k = curve.at_peak();
    mean += curve.angle[k] / row.seeds, strain += curve.strain[k] / row.seeds;
    outer += *std::ranges::max_element(curve.outer) / row.seeds;
    lowest = std::min(lowest, curve.angle[k]), highest = std::max(highest, curve.angle[k]);
    if (seed == 1) figure.series.push_back({.label = row.variant, .x = curve.strain, .y = curve.angle});
  }
  table.add({row.test, row.variant, std::int64_t{row.seeds}, mean, lowest, highest, outer, strain, value_of(row.theory),
             value_of(row.published)});
  fmt::print(stderr, "{} {}: {:.1f}, by outer section {:.1f}\n", row.test, row.variant, mean, outer);
}

int print_table(const std::string& folder, const std::string& only) {
  Table table = empty_table();
  std::map<std::string, Figure> figures;
  for (const Row& row : all_rows()) {
    if (!only.empty() && only != row.test) continue;
    Figure& figure = figures[row.test];
    figure.x = {.title = "axial strain [%]"}, figure.y = {.title = "friction angle [°]"};
    add_row(row, table, figure);
  }
  fmt::print("{}", table.text());
  if (!only.empty()) return 0;
  write_file(folder + "/membranes.json", table.json().dump(2) + "\n");
  for (auto& [name, figure] : figures) write_figure(figure, fmt::format("{}/figures/membranes_{}.svg", folder, name));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Rods and balls in membranes: membranes.json and its figures", "table_membranes"};
  std::string folder = "docs", only;
  app.add_option("folder", folder, "where they are written")->check(CLI::ExistingDirectory)->capture_default_str();
  std::set<std::string> names;
  for (const Row& row : all_rows()) names.insert(row.test);
  app.add_option("test", only, "one of the tests alone: only printed")->check(CLI::IsMember(names));
  return test::run_program(app, argc, argv, [&] { return print_table(folder, only); });
}
