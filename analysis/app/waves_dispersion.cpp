// eigengrain waves dispersion: Bloch waves of a periodic packing along a path through the Brillouin zone.
#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "app/packing_input.hpp"
#include "app/spring_file.hpp"
#include "app/waves_commands.hpp"
#include "assembly/linearise.hpp"
#include "assembly/stiffness.hpp"
#include "base/error.hpp"
#include "base/progress.hpp"
#include "io/hdf5_file.hpp"
#include "report/table.hpp"
#include "stiffness/elastic_tensor.hpp"
#include "stiffness/relaxation.hpp"
#include "waves/dispersion.hpp"
#include "waves/unit_cell.hpp"

namespace eg {
namespace {

struct DispersionFlags {
  PackingFlags packing;
  std::string path, figure, tables, springs;
  int points = 40;
};

struct Slope {
  std::string name;  ///< of the point that the direction leads to
  Vec3 direction;
  std::vector<double> speeds;   ///< of Bloch waves, slowest first [m/s]
  std::vector<double> elastic;  ///< of the elastic tensor, likewise
};

struct DispersionReport {
  std::string name, title;
  UnitCell unit;
  std::size_t particles = 0;
  std::vector<ZonePoint> path;
  Dispersion bands;
  std::vector<Slope> slopes;
  double elapsed = 0;  ///< [s]
};

constexpr std::size_t most_rows = 1500;  // of a dense Hermitian problem at every wave vector: seconds each

/// Edges of the conventional cell if the packing is a block of a lattice, else of its periodic cell.
Mat3 conventional_edges(const Snapshot& work) {
  Mat3 edges = work.state.cell.h;
  if (work.scene.specimen.source != SpecimenSpec::Source::lattice) return edges;
  for (int column = 0; column < work.scene.dimension; ++column)
    for (int row = 0; row < 3; ++row) edges(row, column) /= work.scene.specimen.cells[static_cast<std::size_t>(column)];
  return edges;
}

UnitCell unit_cell_of(const Snapshot& work, const std::string& input) {
  for (int k = 0; k < work.scene.dimension; ++k)
    if (!work.state.cell.periodic[static_cast<std::size_t>(k)])
      throw input_error(input, 0, "the packing", "is not periodic, and Bloch waves need a cell that repeats",
                        "set boundary.type = \"periodic\"");
  std::vector<Vec3> position;
  for (const auto& q : work.state.grains.position) position.push_back(q.vec());
  UnitCell unit = find_unit_cell(linearise(work.scene, work.state), position, work.state.cell.h);
  if (const auto rows = total_dofs(unit.network); rows > most_rows)
    throw input_error(input, 0, fmt::format("the unit cell of {} grains", unit.network.size()),
                      fmt::format("has {} degrees of freedom, more than the {} of a dense problem", rows, most_rows),
                      "take a smaller packing, or ask `eigengrain waves modes`");
  return unit;
}

/// Elastic tensor of the unit cell and its density: what long waves must follow.
struct Continuum {
  ElasticTensor tensor;
  double density = 0;  ///< [kg/m³]
};

Continuum continuum_of(const UnitCell& unit) {
  const double volume = std::abs(determinant(unit.edges));
  const int dimension = unit.network.dimension;
  Continuum c{{dimension, relax(unit.network, periodic_strains(dimension), volume).total()}, 0};
  for (const double inverse : unit.network.inverse_mass) c.density += inverse > 0 ? 1 / (inverse * volume) : 0;
  return c;
}

/// Long waves along every leg of the path that begins or ends at Γ.
std::vector<Slope> slopes_of(const DispersionReport& r, const Mat3& edges) {
  std::vector<Slope> slopes;
  const double edge = std::cbrt(std::abs(determinant(r.unit.edges)));
  const Continuum continuum = continuum_of(r.unit);
  const auto at_origin = [](const ZonePoint& p) { return norm(p.reduced) == 0; };
  for (std::size_t leg = 0; leg + 1 < r.path.size(); ++leg) {
    const bool from = at_origin(r.path[leg]), to = at_origin(r.path[leg + 1]);
    if (from == to) continue;
    const ZonePoint& end = from ? r.path[leg + 1] : r.path[leg];
    const Vec3 k = wave_vector(edges, end.reduced);
    const Vec3 n = k * (1 / norm(k));
    Slope slope{end.name, n, long_wave_speeds(r.unit.network, k, edge), {}};
    const auto elastic = wave_speeds(continuum.tensor, continuum.density, n).speed;
    for (auto m = slope.speeds.size(); m-- > 0;) slope.elastic.push_back(elastic[m]);
    slopes.push_back(slope);
  }
  return slopes;
}

Table corner_table(const DispersionReport& r) {
  Table t({{"point"}, {"branch"}, {"frequency", "", "Hz", 7}, {"rotation", "rotation share", "-", 3}});
  for (std::size_t c = 0; c < r.path.size(); ++c) {
    const auto& modes = r.bands.points[r.bands.corners[c]].modes;
    for (std::size_t m = 0; m < std::min<std::size_t>(modes.size(), 12); ++m)
      t.add({m == 0 ? Value(shown_name(r.path[c].name)) : Value(std::string()), static_cast<std::int64_t>(m + 1),
             modes[m].frequency(), modes[m].rotation});
  }
  return t;
}

Table slope_table(const DispersionReport& r) {
  Table t({{"towards"},
           {"direction"},
           {"speed_1", "slowest", "m/s", 7},
           {"speed_2", "", "m/s", 7},
           {"speed_3", "fastest", "m/s", 7},
           {"elastic", "by the elastic tensor", "m/s"}});
  for (const auto& s : r.slopes) {
    const auto& n = s.direction;
    std::vector<Value> row{shown_name(s.name), fmt::format("{:.3f} {:.3f} {:.3f}", n.x, n.y, n.z)};
    for (std::size_t k = 0; k < 3; ++k) row.push_back(k < s.speeds.size() ? Value(s.speeds[k]) : Value());
    std::string elastic;
    for (const double c : s.elastic) elastic += fmt::format("{}{:.7g}", elastic.empty() ? "" : "  ", c);
    row.push_back(elastic);
    t.add(row);
  }
  return t;
}

std::string text_of(const DispersionReport& r) {
  const auto& net = r.unit.network;
  std::string out = fmt::format("{}{}\n", r.name, r.title.empty() ? "" : ": " + r.title);
  const auto line = [&](const char* key, const std::string& value) { out += fmt::format("  {:<24}{}\n", key, value); };
  line("particles",
       fmt::format("{}, {} of the unit cell {}", r.particles, r.unit.copies, r.unit.copies == 1 ? "copy" : "copies"));
  line("unit cell", fmt::format("{} grains, {} contacts, {} branches", net.size(), net.contacts(), total_dofs(net)));
  out += fmt::format("\nat the points of the path{}:\n{}", total_dofs(net) > 12 ? " (twelve slowest branches)" : "",
                     corner_table(r).text());
  if (!r.slopes.empty()) out += fmt::format("\nlong waves:\n{}", slope_table(r).text());
  out += fmt::format("\n{} wave vectors; {}\n", r.bands.points.size(), duration_text(r.elapsed));
  return out;
}

nlohmann::json json_of(const DispersionReport& r) {
  nlohmann::json j{{"input", r.name},
                   {"title", r.title},
                   {"particles", r.particles},
                   {"unit_cell",
                    {{"particles", r.unit.network.size()},
                     {"contacts", r.unit.network.contacts()},
                     {"copies", r.unit.copies},
                     {"edges_m", nlohmann::json::array()}}},
                   {"corners", nlohmann::json::array()},
                   {"points", nlohmann::json::array()},
                   {"long_waves", nlohmann::json::array()},
                   {"elapsed_s", r.elapsed}};
  const auto vector = [](const Vec3& v) { return nlohmann::json{v.x, v.y, v.z}; };
  for (int c = 0; c < 3; ++c)
    j["unit_cell"]["edges_m"].push_back({r.unit.edges(0, c), r.unit.edges(1, c), r.unit.edges(2, c)});
  for (std::size_t c = 0; c < r.path.size(); ++c)
    j["corners"].push_back(
        {{"name", r.path[c].name}, {"point", r.bands.corners[c]}, {"reduced", vector(r.path[c].reduced)}});
  for (const auto& p : r.bands.points) {
    nlohmann::json row{{"k_rad_per_m", vector(p.k)}, {"distance_rad_per_m", p.distance}};
    for (const auto& m : p.modes) row["frequency_Hz"].push_back(m.frequency()), row["rotation"].push_back(m.rotation);
    j["points"].push_back(row);
  }
  for (const auto& s : r.slopes)
    j["long_waves"].push_back({{"towards", s.name},
                               {"direction", vector(s.direction)},
                               {"speeds_m_per_s", s.speeds},
                               {"elastic_speeds_m_per_s", s.elastic}});
  return j;
}

void write_tables(const DispersionReport& r, const std::string& path) {
  std::vector<double> k, distance, frequency, rotation;
  for (const auto& p : r.bands.points) {
    k.insert(k.end(), {p.k.x, p.k.y, p.k.z}), distance.push_back(p.distance);
    for (const auto& m : p.modes) frequency.push_back(m.frequency()), rotation.push_back(m.rotation);
  }
  const auto points = distance.size(), branches = frequency.size() / points;
  Hdf5Writer file(path, path);
  file.write("k", "rad/m", {points, 3}, k);
  file.write("distance", "rad/m", {points}, distance);
  file.write("frequency", "Hz", {points, branches}, frequency);
  file.write("rotation", "-", {points, branches}, rotation);
  file.close();
}

Figure figure_of(const DispersionReport& r) {
  Figure figure;
  figure.title = r.title.empty() ? r.name : r.title;
  figure.subtitle =
      fmt::format("unit cell of {} grains, {} branches", r.unit.network.size(), total_dofs(r.unit.network));
  figure.y = {.title = "frequency [kHz]", .low = 0};
  figure.shades = Shades{.title = "share of rotation in the kinetic energy [-]",
                         .colours = {{0.05, 0.20, 0.45}, {0.45, 0.40, 0.55}, {0.95, 0.62, 0.15}}};
  for (const auto& p : r.bands.points)
    for (const auto& m : p.modes) {
      figure.shaded.x.push_back(p.distance), figure.shaded.y.push_back(1e-3 * m.frequency());
      figure.shaded.value.push_back(m.rotation);
    }
  for (std::size_t c = 0; c < r.path.size(); ++c) {
    const double at = r.bands.points[r.bands.corners[c]].distance;
    figure.x.marks.emplace_back(at, shown_name(r.path[c].name));
    figure.references.push_back({.from = at, .colour = {0.6, 0.6, 0.63}, .dash = Dash::solid});
  }
  figure.x.title = "wave vector";
  figure.x.low = 0, figure.x.high = r.bands.points.back().distance;
  return figure;
}

int dispersion_command(const DispersionFlags& flags) {
  check_figure(flags.figure);
  const Snapshot work = load_packing(flags.packing);
  const auto begin = std::chrono::steady_clock::now();
  DispersionReport r;
  r.name = flags.packing.input, r.title = work.scene.title, r.particles = work.state.grains.size();
  const auto& lattice = work.scene.specimen.lattice;
  const int dimension = work.scene.dimension;
  r.path = parse_zone_path(flags.path.empty() ? usual_path(lattice, dimension) : flags.path, lattice, dimension);
  r.unit = unit_cell_of(work, flags.packing.input);
  const Mat3 edges = conventional_edges(work);
  Progress progress("wave vectors", 1, "");
  r.bands = dispersion(r.unit.network, edges, r.path, flags.points, [&](double share) { progress.update(share); });
  progress.finish();
  r.slopes = slopes_of(r, edges);
  r.elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (flags.packing.json)
    fmt::print("{}\n", json_of(r).dump(2));
  else
    fmt::print("{}", text_of(r));
  if (!flags.tables.empty()) write_tables(r, flags.tables);
  if (!flags.springs.empty()) write_springs(r.unit.network, flags.springs);
  if (!flags.figure.empty()) save_figure(figure_of(r), flags.figure);
  return 0;
}

}  // namespace

void add_waves_dispersion(CLI::App& waves, Action& action) {
  auto* sub = waves.add_subcommand("dispersion", "frequencies of Bloch waves along a path of wave vectors");
  auto f = std::make_shared<DispersionFlags>();
  add_packing_options(*sub, f->packing);
  sub->add_option("--path", f->path,
                  "points of the Brillouin zone: names (G is the origin) or numbers in units of 2 pi over the edges of "
                  "the conventional cell, e.g. \"G X 0.5,0.5,0\" (default: through the points of the lattice)");
  sub->add_option("--points", f->points, "wave vectors between two points of the path")->check(CLI::Range(1, 100000));
  sub->add_option("--figure", f->figure, "draw the branches (.svg, .png or .pdf)");
  sub->add_option("--tables", f->tables, "write all wave vectors, frequencies and rotation shares (HDF5)");
  sub->add_option("--springs", f->springs, "write masses and springs of the unit cell (text, see matlab_compat/)");
  sub->callback([f, &action] { action = [f] { return dispersion_command(*f); }; });
}

}  // namespace eg
