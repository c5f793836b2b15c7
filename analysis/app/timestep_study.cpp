#include "app/timestep_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "app/prepare.hpp"
#include "assembly/linearise.hpp"
#include "base/error.hpp"
#include "dynamics/engine.hpp"
#include "measure/homogenised.hpp"
#include "report/table.hpp"
#include "specimen/make_packing.hpp"
#include "specimen/make_state.hpp"
#include "timestep/controller.hpp"

namespace eg {
namespace {

constexpr std::array<double, 2> size_ratios{2, 4};               // beside 1
constexpr std::array<double, 4> stiffness_ratios{0, 0.5, 1, 2};  // kt/kn, beside Mindlin's
constexpr std::array<const char*, 3> lattices{"fcc", "bcc", "sc"};

double nan() { return std::numeric_limits<double>::quiet_NaN(); }

/// The middle of the interval, which the rules are held against.
double limit(const StepInterval& i) { return std::sqrt(i.dt_safe * i.dt_limit_upper); }

EstimateMaterial material_of(const Scene& scene) {
  const Material& m = scene.materials.front();
  return {m.shear_modulus, m.poisson, m.density, std::nullopt};
}

StudyRow row_of(const Scene& scene, const std::string& packing, const Network& net) {
  StudyRow row;
  row.packing = packing;
  row.pressure = row.overlap = nan();
  row.stiffness_ratio = net.springs.empty() ? 0 : net.springs.front().tangential / net.springs.front().normal;
  row.interval = step_interval(net);
  row.estimates = time_step_estimates(net, material_of(scene));
  return row;
}

StudyRow row_of(const Scene& scene, const State& state, const std::string& packing, double pressure, double ratio) {
  StudyRow row = row_of(scene, packing, linearise(scene, state));
  row.pressure = pressure, row.size_ratio = ratio;
  row.overlap = homogenise(scene, state).largest_overlap;
  return row;
}

/// Equal frictionless spheres in contact along the space diagonal: λ = 2 kn/m, while the diagonal of K is kn/3 a grain.
Network two_spheres() {
  Network net;
  net.inverse_mass = {1, 1}, net.inverse_inertia = {10, 10}, net.radius = {0.5, 0.5}, net.id = {1, 2};
  const double c = 1 / std::sqrt(3.0);
  net.springs = {{0, 1, 0.5, 0.5, 1, 0, {c, c, c}, 1}};
  return net;
}

double pressure_of(const Scene& scene, const StageSpec& stage) {
  const auto& c = stage.control[0];
  if (c.kind != ComponentControl::Kind::stress)
    throw InputError(
        fmt::format("{}: stage \"{}\" must drive an isotropic stress for a study", scene.file, stage.name));
  return c.value;
}

void add_lattices(const Scene& scene, std::vector<StudyRow>& rows) {
  for (const char* lattice : lattices)
    for (const auto& stage : scene.stages) {
      Scene one = scene;
      one.specimen.source = SpecimenSpec::Source::lattice;
      one.specimen.lattice = lattice;
      one.specimen.radius = scene.specimen.grading.min_radius;
      one.specimen.pressure = pressure_of(scene, stage);
      const State state = make_specimen(one);
      State touching = state;
      Engine engine(one, touching);
      rows.push_back(row_of(one, touching, lattice, one.specimen.pressure, 1));
    }
}

/// The stages of the scene, a row at the end of each.
void add_random(Scene scene, double ratio, std::vector<StudyRow>& rows,
                const std::function<void(const std::string&)>& note) {
  Grading& g = scene.specimen.grading;
  if (ratio > 1) g = {Grading::Kind::uniform, g.min_radius, ratio * g.min_radius, {}};
  State state = make_specimen(scene);
  Controller controller(scene);
  RunObserver observer;
  observer.stage_end = [&](const State& s, const StageSpec& stage) {
    rows.push_back(row_of(scene, s, "random", pressure_of(scene, stage), ratio));
    note(fmt::format("random packing, size ratio {:g}: {}", ratio, stage.name));
  };
  run_stages(scene, state, controller, observer);
  if (ratio > 1) return;
  for (const double k : stiffness_ratios) {
    Network net = linearise(scene, state);
    for (Spring& s : net.springs) s.tangential = k * s.normal;
    StudyRow row = row_of(scene, "random", net);
    row.pressure = rows.back().pressure, row.overlap = rows.back().overlap;
    rows.push_back(std::move(row));
  }
}

const Estimate* find(const StudyRow& row, const std::string& name) {
  const auto at = std::ranges::find(row.estimates, name, &Estimate::name);
  return at == row.estimates.end() ? nullptr : &*at;
}

std::vector<std::string> rules(const std::vector<StudyRow>& rows) {
  std::vector<std::string> names;
  for (const auto& row : rows)
    for (const auto& e : row.estimates)
      if (std::ranges::find(names, e.name) == names.end()) names.push_back(e.name);
  std::ranges::sort(names);
  return names;
}

bool unstable(const StudyRow& row, const Estimate& e) { return e.dt > row.interval.dt_limit_upper; }

std::string cell(const StudyRow& row, const Estimate* e) {
  if (!e) return "-";
  return fmt::format("{:.2f}{}", e->dt / limit(row.interval), unstable(row, *e) ? "!" : " ");
}

}  // namespace

std::vector<StudyRow> timestep_study(const Scene& scene, const std::function<void(const std::string&)>& note) {
  if (scene.specimen.source != SpecimenSpec::Source::cloud || scene.specimen.grading.kind != Grading::Kind::single ||
      !scene.contact.law.starts_with("hertz-mindlin") || scene.stages.empty())
    throw InputError(fmt::format(
        "{}: a study needs a cloud of single size, a Hertz-Mindlin law and stages of isotropic stress; begin with "
        "cases/timestep_study.toml",
        scene.file));
  std::vector<StudyRow> rows{row_of(scene, "two spheres", two_spheres())};
  for (auto* e : {&rows.front()})  // rules of material belong to no spring of unit stiffness
    std::erase_if(e->estimates, [](const Estimate& x) {
      return x.name.starts_with("rayleigh") || x.name.starts_with("p-wave") || !std::isfinite(x.dt);
    });
  add_lattices(scene, rows);
  note("lattices");
  add_random(scene, 1, rows, note);
  for (const double ratio : size_ratios) add_random(scene, ratio, rows, note);
  return rows;
}

std::string text_of(const std::vector<StudyRow>& rows) {
  const auto names = rules(rows);
  std::vector<Column> columns{{"packing"},
                              {"pressure", "p", "kPa"},
                              {"size_ratio", "Rmax/Rmin"},
                              {"stiffness_ratio", "kt/kn", "", 3},
                              {"overlap", "max d/2R", "", 2},
                              {"limit", "limit", "s"}};
  for (const auto& n : names) columns.push_back({n});
  Table table(columns);
  for (const auto& r : rows) {
    const auto number = [](double x) { return std::isnan(x) ? Value{} : Value{x}; };
    std::vector<Value> row{r.packing,         number(r.pressure / 1e3), r.size_ratio,
                           r.stiffness_ratio, number(r.overlap),        limit(r.interval)};
    for (const auto& n : names) row.push_back(cell(r, find(r, n)));
    table.add(std::move(row));
  }
  Table summary(
      {{"rule"}, {"unstable", "unstable in"}, {"most", "largest"}, {"least", "smallest"}, {"where", "largest at"}});
  for (const auto& n : names) {
    std::int64_t bad = 0, all = 0;
    double most = 0, least = INFINITY;
    std::string where;
    for (const auto& r : rows) {
      const Estimate* e = find(r, n);
      if (!e) continue;
      const double x = e->dt / limit(r.interval);
      ++all, bad += unstable(r, *e), least = std::min(least, x);
      if (x > most)
        most = x, where = std::isnan(r.pressure) ? r.packing
                                                 : fmt::format("{}, {:g} kPa, ratio {:g}, kt/kn {:.2f}", r.packing,
                                                               r.pressure / 1e3, r.size_ratio, r.stiffness_ratio);
    }
    summary.add({n, fmt::format("{} of {}", bad, all), most, least, where});
  }
  return fmt::format("Estimate over limit; ! marks a step that is proved unstable.\n\n{}\n{}", table.text(),
                     summary.text());
}

nlohmann::json json_of(const std::vector<StudyRow>& rows) {
  auto all = nlohmann::json::array();
  for (const auto& r : rows) {
    nlohmann::json estimates = nlohmann::json::object();
    for (const auto& e : r.estimates)
      estimates[e.name] = {{"dt", e.dt}, {"ratio", e.dt / limit(r.interval)}, {"unstable", unstable(r, e)}};
    all.push_back({{"packing", r.packing},
                   {"pressure_Pa", r.pressure},
                   {"size_ratio", r.size_ratio},
                   {"stiffness_ratio", r.stiffness_ratio},
                   {"largest_overlap", r.overlap},
                   {"dt_safe", r.interval.dt_safe},
                   {"dt_limit_upper", r.interval.dt_limit_upper},
                   {"method", r.interval.method_upper},
                   {"estimates", estimates}});
  }
  return all;
}

Figure figure_of(const std::vector<StudyRow>& rows) {
  Figure figure;
  figure.title = "Rules of thumb over the true limit";
  figure.subtitle = "FCC and random packing (size ratio 4), Hertz–Mindlin";
  figure.x = {.title = "isotropic stress [Pa]", .logarithmic = true};
  figure.y = {.title = "estimate / limit [-]", .logarithmic = true};
  figure.references.push_back({.axis = Reference::Across::y, .from = 1, .label = "unstable above"});
  for (const char* rule : {"rayleigh-rmin", "yade", "itasca", "cundall-strack", "element"})
    for (const bool lattice : {true, false}) {
      Series s{.label = fmt::format("{}, {}", rule, lattice ? "FCC" : "random"), .points = true};
      for (const auto& r : rows) {
        const Estimate* e = find(r, rule);
        if (!e || std::isnan(r.pressure) || (lattice ? r.packing != "fcc" : r.packing != "random" || r.size_ratio != 4))
          continue;
        s.x.push_back(r.pressure), s.y.push_back(e->dt / limit(r.interval));
      }
      figure.series.push_back(std::move(s));
    }
  figure.width = 640, figure.height = 460;
  return figure;
}

}  // namespace eg
