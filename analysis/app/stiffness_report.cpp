#include "app/stiffness_report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "base/progress.hpp"
#include "io/hdf5_file.hpp"
#include "report/table.hpp"

namespace eg {
namespace {

constexpr double pi = std::numbers::pi;

DirectionRow along(const StiffnessReport& r, const Vec3& direction) {
  const Vec3 n = (1 / norm(direction)) * direction;
  return {n, young_modulus(r.tensor, n), poisson_ratio(r.tensor, n), wave_speeds(r.tensor, r.density, n)};
}

/// Directions spread evenly over half the sphere (Vogel's spiral), in 2D over half the circle.
std::vector<Vec3> spread(int dimension) {
  constexpr int points = 1000;
  std::vector<Vec3> directions;
  for (int k = 0; k < points; ++k) {
    const double z = dimension == 3 ? (k + 0.5) / points : 0.0, s = std::sqrt(1 - z * z);
    const double angle = dimension == 3 ? k * pi * (3 - std::sqrt(5.0)) : k * pi / points;
    directions.push_back({s * std::cos(angle), s * std::sin(angle), z});
  }
  return directions;
}

std::vector<SpeedRange> speed_ranges(const std::vector<DirectionRow>& rows, int dimension) {
  std::vector<SpeedRange> ranges(static_cast<std::size_t>(dimension), {1e300, 0, 0});
  for (const auto& row : rows)
    for (std::size_t w = 0; w < ranges.size(); ++w) {
      const double c = row.waves.speed[w];
      ranges[w].lowest = std::min(ranges[w].lowest, c), ranges[w].highest = std::max(ranges[w].highest, c);
      ranges[w].mean += c / static_cast<double>(rows.size());
    }
  return ranges;
}

std::vector<EffectiveRow> effective_rows(const StiffnessReport& r, const Network& network, const Material& m) {
  std::vector<EffectiveRow> rows;
  rows.push_back({"kinematic", "summed over the contacts; an upper bound", {r.affine.bulk, r.affine.shear}});
  if (r.dimension == 2 || network.springs.empty()) return rows;
  const auto& h = r.state;
  const MeanPacking packing{h.coordination.mean, h.solid_fraction, h.sizes.mean / 2};
  double kn = 0, kt = 0;
  for (const Spring& s : network.springs)
    if (!s.couple) kn += s.normal, kt += s.tangential;
  const auto count = static_cast<double>(network.contacts());
  rows.push_back({"mean-field", "from Z, φ, mean R, mean kn and kt", mean_field(packing, kn / count, kt / count)});
  if (std::isnan(m.shear_modulus) || !(h.mean_stress > 0)) return rows;
  const double g = m.shear_modulus, nu = m.poisson, p = h.mean_stress;
  rows.push_back({"walton-rough", "Walton 1987; from p, Z, φ", walton_rough(packing, g, nu, p)});
  rows.push_back({"walton-smooth", "Walton 1987; no friction", walton_smooth(packing, g, nu, p)});
  rows.push_back({"digby", "Digby 1981; contacts not bonded before", digby(packing, g, nu, p, 0)});
  return rows;
}

std::string direction_text(const Vec3& n, int dimension) {
  return dimension == 3 ? fmt::format("{:.3f} {:.3f} {:.3f}", n.x, n.y, n.z) : fmt::format("{:.3f} {:.3f}", n.x, n.y);
}

const char* stress_unit(const StiffnessReport& r) { return r.dimension == 3 ? "Pa" : "N/m"; }

Table moduli_table(const StiffnessReport& r, const Eigen::MatrixXd& c) {
  std::vector<Column> columns{{"row", ""}};
  for (const auto& name : r.loads) columns.push_back({name, "", stress_unit(r), 5});
  Table t(columns);
  const double nothing = 1e-12 * c.cwiseAbs().maxCoeff();  // round-off, shown as 0
  for (Eigen::Index a = 0; a < c.rows(); ++a) {
    std::vector<Value> row{r.loads[static_cast<std::size_t>(a)]};
    for (Eigen::Index b = 0; b < c.cols(); ++b) row.push_back(std::abs(c(a, b)) > nothing ? c(a, b) : 0.0);
    t.add(row);
  }
  return t;
}

Table direction_table(const StiffnessReport& r) {
  const char* unit = stress_unit(r);
  std::vector<Column> columns{{"direction"}, {"young", "E", unit}, {"poisson", "ν", "-"}, {"p", "P", "m/s", 5}};
  columns.push_back({"s1", "S1", "m/s", 5});
  if (r.dimension == 3) columns.push_back({"s2", "S2", "m/s", 5});
  Table t(columns);
  for (const auto& d : r.directions) {
    std::vector<Value> row{direction_text(d.direction, r.dimension), d.young, d.poisson};
    for (int w = 0; w < r.dimension; ++w) row.push_back(d.waves.speed[static_cast<std::size_t>(w)]);
    t.add(row);
  }
  return t;
}

Table effective_table(const StiffnessReport& r) {
  Table t({{"name", "theory"},
           {"bulk", "K", stress_unit(r)},
           {"shear", "G", stress_unit(r)},
           {"bulk_ratio", "over K", "-", 3},
           {"shear_ratio", "over G", "-", 3},
           {"source"}});
  for (const auto& e : r.effective)
    t.add({e.name, e.moduli.bulk, e.moduli.shear, e.moduli.bulk / r.isotropic.bulk, e.moduli.shear / r.isotropic.shear,
           e.source});
  return t;
}

double misfit(const ProbedModuli& probed, const RelaxedModuli& moduli) {
  return (probed.voigt - moduli.total()).norm() / moduli.total().norm();
}

std::string fits_text(const StiffnessReport& r) {
  std::string out;
  const auto line = [&](const char* key, const std::string& value) { out += fmt::format("  {:<24}{}\n", key, value); };
  const char* unit = stress_unit(r);
  line("positive definite", r.eigenmoduli(0) > 0
                                ? fmt::format("yes, least eigenmodulus {:.4g} {}", r.eigenmoduli(0), unit)
                                : fmt::format("NO, least eigenmodulus {:.4g} {}", r.eigenmoduli(0), unit));
  const auto& i = r.isotropic;
  line("isotropic fit", fmt::format("K = {:.5g}, G = {:.5g}, E = {:.5g} {}, ν = {:.4f}; misfit {:.2g} %", i.bulk,
                                    i.shear, i.young, unit, i.poisson, 100 * i.misfit));
  if (r.transverse) {
    const auto& t = *r.transverse;
    line("transversely isotropic", fmt::format("axis {}; misfit {:.2g} %", direction_text(t.axis, 3), 100 * t.misfit));
    line("", fmt::format("C11 = {:.5g}, C33 = {:.5g}, C13 = {:.5g}, C44 = {:.5g}, C66 = {:.5g} Pa", t.c11, t.c33, t.c13,
                         t.c44, t.c66));
  }
  line("stiffest direction",
       std::isnan(r.fabric_angle)
           ? "none to compare: moduli or fabric are alike along several axes"
           : fmt::format("{}; the fabric's {}, {:.1f}° apart", direction_text(r.principal.axes[0], r.dimension),
                         direction_text(r.fabric.axes[0], r.dimension), r.fabric_angle));
  const double whole = r.moduli.total().trace();
  line("share of the springs",
       fmt::format("normal {:.1f} %, tangential {:.1f} % of the trace", 100 * r.moduli.normal.trace() / whole,
                   100 * r.moduli.tangential.trace() / whole));
  return out;
}

std::string waves_text(const StiffnessReport& r) {
  std::string out = fmt::format("\nalong directions (density {:.5g} kg/m{}):\n{}", r.density,
                                r.dimension == 3 ? "³" : "²", direction_table(r).text());
  out += "over all directions:";
  for (std::size_t w = 0; w < r.ranges.size(); ++w)
    out += fmt::format("  {} {:.5g} … {:.5g} m/s", std::array{"P", "S1", "S2"}[w], r.ranges[w].lowest,
                       r.ranges[w].highest);
  return out + fmt::format("\n\ntheories of the mean field beside K and G:\n{}", effective_table(r).text());
}

std::string probe_text(const StiffnessReport& r) {
  const auto& p = *r.probed;
  std::string out =
      fmt::format("\nfound by straining the packing itself ({} steps){}:\n{}", p.steps,
                  p.found ? "" : "; NOT LINEAR at any strain tried, or not at rest", moduli_table(r, p.voigt).text());
  out += fmt::format("differs from the matrix's by {:.2g} %; linear up to", 100 * misfit(p, r.moduli));
  for (std::size_t a = 0; a < r.loads.size(); ++a) out += fmt::format(" {} {:.0e}", r.loads[a], p.linear[a]);
  return out + "\n";
}

nlohmann::json json_matrix(const Eigen::MatrixXd& m) {
  auto rows = nlohmann::json::array();
  for (Eigen::Index a = 0; a < m.rows(); ++a) {
    auto row = nlohmann::json::array();
    for (Eigen::Index b = 0; b < m.cols(); ++b) row.push_back(m(a, b));
    rows.push_back(row);
  }
  return rows;
}

nlohmann::json json_vector(const Vec3& v) { return {v.x, v.y, v.z}; }

void add_periodic_json(nlohmann::json& j, const StiffnessReport& r) {
  const auto& i = r.isotropic;
  j["eigenmoduli_Pa"] = std::vector<double>(r.eigenmoduli.begin(), r.eigenmoduli.end());
  j["positive_definite"] = r.eigenmoduli(0) > 0;
  j["isotropic"] = {
      {"bulk_Pa", i.bulk}, {"shear_Pa", i.shear}, {"young_Pa", i.young}, {"poisson", i.poisson}, {"misfit", i.misfit}};
  if (r.transverse) {
    const auto& t = *r.transverse;
    j["transversely_isotropic"] = {{"axis", json_vector(t.axis)},
                                   {"C11_Pa", t.c11},
                                   {"C33_Pa", t.c33},
                                   {"C13_Pa", t.c13},
                                   {"C44_Pa", t.c44},
                                   {"C66_Pa", t.c66},
                                   {"misfit", t.misfit}};
  }
  const auto principal = [](const Principal& p) {
    return nlohmann::json{{"values", p.values},
                          {"axes", {json_vector(p.axes[0]), json_vector(p.axes[1]), json_vector(p.axes[2])}}};
  };
  j["principal"] = principal(r.principal);
  j["fabric"] = principal(r.fabric);
  j["fabric_angle_deg"] = r.fabric_angle;
  for (const auto& d : r.directions) {
    nlohmann::json row{{"direction", json_vector(d.direction)}, {"young_Pa", d.young}, {"poisson", d.poisson}};
    for (std::size_t w = 0; w < r.ranges.size(); ++w) row["speeds_m_per_s"].push_back(d.waves.speed[w]);
    j["directions"].push_back(row);
  }
  for (const auto& range : r.ranges) j["speed_ranges_m_per_s"].push_back({range.lowest, range.mean, range.highest});
  for (const auto& e : r.effective)
    j["effective_medium"].push_back(
        {{"name", e.name}, {"bulk_Pa", e.moduli.bulk}, {"shear_Pa", e.moduli.shear}, {"source", e.source}});
}

}  // namespace

void complete(StiffnessReport& r, const Network& network, const std::vector<Vec3>& directions,
              const Material& material) {
  r.tensor = {r.dimension, r.moduli.total()};
  r.eigenmoduli = eigenmoduli(r.tensor);
  r.isotropic = isotropic_fit(r.tensor);
  r.affine = isotropic_fit({r.dimension, r.moduli.affine});
  if (r.dimension == 3) r.transverse = transverse_fit(r.tensor);
  r.principal = principal(dilatational_tensor(r.tensor), r.dimension);
  r.fabric = principal(r.state.fabric, r.dimension);
  const auto directed = [](const Principal& p) { return p.values[0] - p.values[1] > 1e-9 * p.values[0]; };
  if (directed(r.principal) && directed(r.fabric))
    r.fabric_angle = 180 / pi * std::acos(std::min(1.0, std::abs(dot(r.principal.axes[0], r.fabric.axes[0]))));
  if (r.eigenmoduli(0) > 1e-12 * r.eigenmoduli.maxCoeff()) {
    for (const Vec3& n : directions) r.directions.push_back(along(r, n));
    for (const Vec3& n : spread(r.dimension)) r.sphere.push_back(along(r, n));
    r.ranges = speed_ranges(r.sphere, r.dimension);
  }
  r.effective = effective_rows(r, network, material);
}

std::string text_of(const StiffnessReport& r) {
  std::string out = fmt::format("{}{}\n", r.name, r.title.empty() ? "" : ": " + r.title);
  const auto line = [&](const char* key, const std::string& value) { out += fmt::format("  {:<24}{}\n", key, value); };
  line("particles", fmt::format("{} ({}D, {} rotation), {} of them rattlers", r.particles, r.dimension,
                                r.rotation ? "with" : "without", r.rattlers));
  line("contacts", fmt::format("{} that carry, coordination {:.3f}", r.contacts, r.state.coordination.mean));
  line("mean stress", fmt::format("{:.5g} {}", r.state.mean_stress, stress_unit(r)));
  if (r.contacts == 0) return out + "\nNothing touches: the packing has no stiffness. Compress it first.\n";
  const auto& m = r.moduli;
  out += fmt::format("\n{}:\n{}", r.periodic ? "elastic tensor (Voigt)" : "moduli between the rigid walls",
                     moduli_table(r, m.total()).text());
  line("solved by", fmt::format("{}, {} iterations, {}", m.method, m.iterations, duration_text(r.elapsed)));
  line("error", fmt::format("{:.1e} of each diagonal modulus{}; asymmetry of the stresses {:.1e}", m.error,
                            m.converged ? "" : ", NOT CONVERGED", m.asymmetry));
  if (r.periodic) out += fits_text(r);
  if (!r.directions.empty()) out += waves_text(r);
  if (r.probed) out += probe_text(r);
  return out;
}

nlohmann::json json_of(const StiffnessReport& r) {
  const auto& m = r.moduli;
  nlohmann::json j{{"input", r.name},
                   {"title", r.title},
                   {"dimension", r.dimension},
                   {"rotation", r.rotation},
                   {"periodic", r.periodic},
                   {"particles", r.particles},
                   {"rattlers", r.rattlers},
                   {"contacts", r.contacts},
                   {"coordination", r.state.coordination.mean},
                   {"solid_fraction", r.state.solid_fraction},
                   {"mean_stress_Pa", r.state.mean_stress},
                   {"volume", r.volume},
                   {"density", r.density},
                   {"rows", r.loads},
                   {"moduli_Pa", json_matrix(m.total())},
                   {"affine_Pa", json_matrix(m.affine)},
                   {"normal_part_Pa", json_matrix(m.normal)},
                   {"tangential_part_Pa", json_matrix(m.tangential)},
                   {"solution",
                    {{"method", m.method},
                     {"iterations", m.iterations},
                     {"error", m.error},
                     {"asymmetry", m.asymmetry},
                     {"converged", m.converged}}},
                   {"elapsed_s", r.elapsed}};
  if (r.periodic && r.contacts > 0) add_periodic_json(j, r);
  if (r.probed)
    j["probe"] = {{"moduli_Pa", json_matrix(r.probed->voigt)},
                  {"strain", r.probed->strain},
                  {"linear_up_to", r.probed->linear},
                  {"steps", r.probed->steps},
                  {"found", r.probed->found},
                  {"difference", misfit(*r.probed, m)}};
  return j;
}

Figure figure_of(const StiffnessReport& r) {
  Figure figure;
  figure.title = r.title.empty() ? r.name : r.title;
  figure.subtitle =
      fmt::format("{} particles, p = {:.4g} {}; K = {:.4g}, G = {:.4g} {}", r.particles, r.state.mean_stress,
                  stress_unit(r), r.isotropic.bulk, r.isotropic.shear, stress_unit(r));
  const std::vector<Vec3> corners = r.dimension == 3 ? std::vector<Vec3>{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}}
                                                     : std::vector<Vec3>{{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}};
  figure.x = {.title = "direction, by the angle from axis to axis"};
  for (std::size_t c = 0; c < corners.size(); ++c) {
    figure.x.marks.emplace_back(90.0 * static_cast<double>(c), corners[c].y != 0 ? "y" : corners[c].z != 0 ? "z" : "x");
    if (c > 0 && c + 1 < corners.size())
      figure.references.push_back({.from = 90.0 * static_cast<double>(c), .colour = {0.6, 0.6, 0.63}});
  }
  double fastest = 0;
  for (std::size_t w = 0; w < r.ranges.size(); ++w) {
    Series s{.label = std::array{"P", "S1", "S2"}[w]};
    for (std::size_t leg = 0; leg + 1 < corners.size(); ++leg)
      for (int angle = 0; angle <= 90; angle += 2) {
        const double t = angle * pi / 180;
        const auto waves =
            wave_speeds(r.tensor, r.density, std::cos(t) * corners[leg] + std::sin(t) * corners[leg + 1]);
        s.x.push_back(90.0 * static_cast<double>(leg) + angle), s.y.push_back(waves.speed[w]);
        fastest = std::max(fastest, s.y.back());
      }
    figure.series.push_back(std::move(s));
  }
  figure.y = {.title = "wave speed [m/s]", .low = 0, .high = 1.3 * fastest};
  return figure;
}

void write_tables(const StiffnessReport& r, const std::string& path) {
  Hdf5Writer file(path, path);
  const auto n = static_cast<unsigned long long>(r.loads.size());
  const auto matrix = [&](const char* name, const Eigen::MatrixXd& m) {
    const std::vector<double> values(m.data(), m.data() + m.size());  // symmetric, or nearly so (probed)
    file.write(name, stress_unit(r), {n, n}, values);
  };
  matrix("moduli", r.moduli.total()), matrix("affine", r.moduli.affine);
  matrix("normal_part", r.moduli.normal), matrix("tangential_part", r.moduli.tangential);
  if (r.probed) matrix("probed", r.probed->voigt.transpose());
  file.write("volume", r.dimension == 3 ? "m3" : "m2", {1}, std::vector{r.volume});
  file.write("density", "kg/m3", {1}, std::vector{r.density});
  std::vector<double> direction, speed, young, poisson;
  for (const auto& d : r.sphere) {
    direction.insert(direction.end(), {d.direction.x, d.direction.y, d.direction.z});
    for (std::size_t w = 0; w < r.ranges.size(); ++w) speed.push_back(d.waves.speed[w]);
    young.push_back(d.young), poisson.push_back(d.poisson);
  }
  const auto rows = static_cast<unsigned long long>(r.sphere.size());
  if (rows > 0) {
    file.write("sphere/direction", "-", {rows, 3}, direction);
    file.write("sphere/speed", "m/s", {rows, r.ranges.size()}, speed);
    file.write("sphere/young", stress_unit(r), {rows}, young);
    file.write("sphere/poisson", "-", {rows}, poisson);
  }
  file.close();
}

}  // namespace eg
