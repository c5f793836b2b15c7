// Regular packings in membranes against theory, laboratory and the simulations of O'Sullivan et al. (2003, 2004).
// Run by: ./dev validation membranes; writes FOLDER/membranes.json and FOLDER/figures/membranes_*.svg.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include "boundary/body_control.hpp"
#include "dynamics/run.hpp"
#include "io/scene_file.hpp"
#include "io/text_file.hpp"
#include "measure/volume.hpp"
#include "report/plot.hpp"
#include "report/table.hpp"
#include "specimen/make_packing.hpp"
#include "specimen/make_state.hpp"
#include "timestep/controller.hpp"

using namespace eg;

namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr int seeds = 3;

/// Friction angle of the platens' stress over the membrane's, and axial strain [%], row by row of the last stage.
struct Curve {
  std::vector<double> strain, angle;
  double peak() const { return *std::ranges::max_element(angle); }
  double peak_strain() const {
    return strain[static_cast<std::size_t>(std::ranges::max_element(angle) - angle.begin())];
  }
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
  const auto stress = [&](const State& s, std::size_t body) {
    return body_load(scene, s, drive_of(scene, s, body)).stress();
  };
  RunObserver observer;
  observer.stage_end = [&](const State& s, const StageSpec&) { height = wall_gap(s, axis).length(); };
  observer.record = [&](const State& s, const RunStatus& status) {
    if (status.stage.name != "shear") return;
    const double major = 0.5 * (stress(s, top) + stress(s, top - 1)), minor = s.membrane.stress;
    curve.strain.push_back(-100 * s.bodies[top].moved[axis] / height);
    curve.angle.push_back(std::asin((major - minor) / (major + minor)) / degree);
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
  double theory, published;  ///< [°]; NaN: none
};

const std::string rods = "hexagonal_biaxial";
constexpr double none = not_given;

std::vector<Row> all_rows() {
  const std::string scattered = R"(contact.friction_scatter={per="contact",deviation=0.2555})";
  std::vector<Row> rows{{rods, "equal", {}, 43.29, 41}, {rods, "friction ± 3.0°", {scattered}, none, 37}};
  for (const double s : {0.5, 1.0, 2.0, 3.0, 5.0})
    rows.push_back({rods,
                    fmt::format("radii ± {} %", s),
                    {fmt::format("specimen.radius_scatter={}", s / 100)},
                    none,
                    s == 0.5   ? 45
                    : s == 5.0 ? 25
                               : none});
  rows.push_back({"fcc_triaxial", "equal", {}, 24.60, 24.4});
  rows.push_back({"rhombic_triaxial", "equal", {}, 41.58, 41.6});
  const std::vector<std::pair<double, double>> laboratory{{0, 40.0}, {0.7, 37.5}, {1.2, 36.0}, {1.9, 32.6}};
  for (const auto& [s, angle] : laboratory)
    rows.push_back({"rhombic_plane_strain",
                    s == 0 ? "equal" : fmt::format("radii ± {} %", s),
                    {fmt::format("specimen.radius_scatter={}", s / 100)},
                    none,
                    angle});
  return rows;
}

Value value_of(double x) { return std::isnan(x) ? Value{} : Value{x}; }

}  // namespace

int main(int count, char** arguments) {
  const std::string folder = count > 1 ? arguments[1] : "docs", only = count > 2 ? arguments[2] : "";
  Table table({{"test"},
               {"variant"},
               {"peak_1", "seed 1", "°", 3},
               {"peak_2", "seed 2", "°", 3},
               {"peak_3", "seed 3", "°", 3},
               {"mean", "mean peak", "°", 3},
               {"strain", "at strain", "%", 2},
               {"theory", "theory", "°", 4},
               {"published", "published", "°", 3}});
  std::map<std::string, Figure> figures;
  for (const Row& row : all_rows()) {
    if (!only.empty() && only != row.test) continue;
    double mean = 0, strain = 0;
    std::vector<Value> cells{row.test, row.variant};
    for (int seed = 1; seed <= seeds; ++seed) {
      const Curve curve = run(row.test, row.settings, seed);
      mean += curve.peak() / seeds, strain += curve.peak_strain() / seeds;
      cells.push_back(curve.peak());
      if (seed > 1) continue;
      Figure& figure = figures[row.test];
      figure.x = {.title = "axial strain [%]"}, figure.y = {.title = "friction angle [°]"};
      figure.series.push_back({.label = row.variant, .x = curve.strain, .y = curve.angle});
    }
    cells.insert(cells.end(), {mean, strain, value_of(row.theory), value_of(row.published)});
    table.add(cells);
    fmt::print(stderr, "{} {}: {:.1f}\n", row.test, row.variant, mean);
  }
  fmt::print("{}", table.text());
  if (!only.empty()) return 0;
  write_file(folder + "/membranes.json", table.json().dump(2) + "\n");
  for (auto& [name, figure] : figures) write_figure(figure, fmt::format("{}/figures/membranes_{}.svg", folder, name));
}
