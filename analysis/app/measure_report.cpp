#include "app/measure_report.hpp"

#include <fmt/format.h>

#include <cmath>

#include "app/record.hpp"
#include "measure/fabric.hpp"
#include "measure/stress.hpp"

namespace eg {
namespace {

using Rows = std::vector<Measured>;

std::int64_t whole(std::size_t n) { return static_cast<std::int64_t>(n); }

/// What all sections are taken from.
struct Source {
  const Scene& scene;
  const State& state;
  std::span<const ContactPoint> contacts;
  Homogenised h;
  std::string pressure, joule, volume;  ///< units

  Source(const Snapshot& packing, std::span<const ContactPoint> all)
      : scene(packing.scene), state(packing.state), contacts(all), h(homogenise(scene, state)) {
    const bool solid = state.dimension == 3;
    pressure = solid ? "Pa" : "N/m", joule = solid ? "J" : "J/m", volume = solid ? "m3" : "m2";
  }
  /// Stress as the history has it: shear positive when it drives a positive shear rate.
  void add_stress(Rows& rows, Mat3 m) const {
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < 3; ++l) m(k, l) *= k == l ? 1 : -1;
    add_tensor(rows, "stress", pressure, m, state.dimension);
  }
  void add_principal(Rows& rows, const std::string& name, const std::string& unit, const Principal& p) const {
    for (std::size_t k = 0; k < static_cast<std::size_t>(state.dimension); ++k)
      rows.push_back({fmt::format("{}_{}", name, k + 1), unit, p.values[k]});
    for (int k = 0; k < state.dimension; ++k)
      rows.push_back({fmt::format("{}_axis_{}", name, "xyz"[k]), "-", p.axes[0][k]});
  }
};

MeasureSection specimen_section(const Source& s) {
  const auto& h = s.h;
  return {"specimen",
          {{"particles", "-", whole(h.coordination.grains)},
           {"contacts", "-", whole(h.coordination.contacts)},
           {"wall_contacts", "-", whole(h.coordination.wall_contacts)},
           {"volume", s.volume, h.volume},
           {"solid_fraction", "-", h.solid_fraction},
           {"void_ratio", "-", h.void_ratio},
           {"void_ratio_corrected", "-", h.void_ratio_corrected},
           {"diameter_smallest", "m", h.sizes.smallest},
           {"diameter_largest", "m", h.sizes.largest},
           {"diameter_mean", "m", h.sizes.mean},
           {"d50", "m", h.sizes.d50}}};
}

MeasureSection stress_section(const Source& s) {
  const auto& h = s.h;
  const Principal p = principal(h.stress, s.state.dimension);
  Rows rows;
  s.add_stress(rows, h.stress);
  rows.push_back({"mean_stress", s.pressure, h.mean_stress});
  rows.push_back({"deviator", s.pressure, h.deviator});
  rows.push_back({"stress_ratio", "-", h.mean_stress != 0 ? h.deviator / h.mean_stress : 0.0});
  s.add_principal(rows, "principal", s.pressure, p);
  rows.push_back({"normal_deviator_share", "-", h.normal_share});
  rows.push_back({"tangential_deviator_share", "-", h.deviator > 0 ? 1 - h.normal_share : 0.0});
  return {"stress", rows};
}

MeasureSection coordination_section(const Source& s, const std::vector<std::size_t>& connectivity) {
  const auto& c = s.h.coordination;
  double four = 0;
  for (std::size_t k = 4; k < connectivity.size(); ++k) four += static_cast<double>(connectivity[k]);
  const auto grains = static_cast<double>(std::max<std::size_t>(1, c.grains));
  return {"coordination",
          {{"coordination", "-", c.mean},
           {"mechanical_coordination", "-", c.mechanical},
           {"rattler_share", "-", rattler_share(c)},
           {"backbone_coordination", "-", s.h.backbone.mean},
           {"backbone_share", "-", static_cast<double>(s.h.backbone.grains) / grains},
           {"four_contacts_share", "-", four / grains}}};
}

MeasureSection fabric_section(const Source& s) {
  Rows rows;
  add_tensor(rows, "fabric", "-", s.h.fabric, s.state.dimension);
  s.add_principal(rows, "fabric", "-", s.h.fabric_axes);
  rows.push_back({"fabric_deviator", "-", anisotropy(s.h.fabric_axes, s.state.dimension)});
  add_tensor(rows, "force_fabric", "-", s.h.force_fabric, s.state.dimension);
  s.add_principal(rows, "force_fabric", "-", s.h.force_fabric_axes);
  rows.push_back({"force_fabric_deviator", "-", anisotropy(s.h.force_fabric_axes, s.state.dimension)});
  return {"fabric", rows};
}

MeasureSection contact_section(const Source& s) {
  const auto& f = s.h.forces;
  const ForceChains chains = force_chains(s.state, s.contacts);
  return {"contacts",
          {{"largest_overlap", "-", s.h.largest_overlap},
           {"sliding_fraction", "-", s.h.sliding_fraction},
           {"mobilised_friction", "-", f.mobilised_friction},
           {"mean_contact_force", "N", f.mean_force},
           {"largest_contact_force", "N", f.largest_force},
           {"strong_contact_share", "-", f.strong_contacts},
           {"strong_mean_stress_share", "-", f.strong_mean_share},
           {"strong_deviator_share", "-", f.strong_deviator_share},
           {"chains", "-", whole(chains.length.size())},
           {"chain_grain_share", "-", chains.grain_share},
           {"chain_mean_length", "grains", chains.mean_length},
           {"chain_longest", "grains", std::int64_t{chains.length.empty() ? 0 : chains.length.front()}}}};
}

MeasureSection motion_section(const Source& s, const Spins& spins) {
  return {"motion",
          {{"time", "s", s.state.time},
           {"driving_rate", "1/s", driving_rate(s.state, current_stage(s.scene, s.state))},
           {"inertial_number", "-", inertial_number_of(s.scene, s.state, s.h)},
           {"unbalanced_force", "-", s.h.unbalanced_force},
           {"spin_deviation", "rad/s", spins.deviation},
           {"spin_largest", "rad/s", spins.largest},
           {"spin_kurtosis", "-", spins.kurtosis}}};
}

MeasureSection energy_section(const Source& s) {
  const EnergyTable e = energies(s.scene, s.state);
  Rows rows{{"kinetic_energy", s.joule, s.h.kinetic_energy},
            {"elastic_normal", s.joule, e.normal},
            {"elastic_shear", s.joule, e.shear}};
  if (s.scene.energy)
    rows.insert(rows.end(), {{"friction_work", s.joule, e.friction},
                             {"shear_path_work", s.joule, e.path},
                             {"damping_work", s.joule, e.damping},
                             {"outside_work", s.joule, e.work},
                             {"energy_residual", s.joule, e.residual}});
  return {"energy", rows};
}

MeasureSection sphere_section(const Source& s, const MeasureSphere& sphere, std::size_t number) {
  const SphereMeasures m = measure_sphere(s.state, s.contacts, sphere);
  Rows rows;
  for (int k = 0; k < s.state.dimension; ++k)
    rows.push_back({fmt::format("centre_{}", "xyz"[k]), "m", sphere.centre[k]});
  rows.push_back({"radius", "m", sphere.radius});
  rows.push_back({"particles", "-", whole(m.grains)});
  rows.push_back({"solid_fraction", "-", m.solid_fraction});
  rows.push_back({"void_ratio", "-", m.void_ratio});
  rows.push_back({"coordination", "-", m.coordination});
  s.add_stress(rows, m.stress);
  rows.push_back({"mean_stress", s.pressure, mean_value(m.stress, s.state.dimension)});
  rows.push_back({"deviator", s.pressure, deviator(m.stress, s.state.dimension)});
  if (m.velocity_gradient) {  // compression positive, shear as engineering rates
    Mat3 rate = *m.velocity_gradient;
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < 3; ++l) rate(k, l) *= k == l ? -1 : 2;
    add_tensor(rows, "strain_rate", "1/s", rate, s.state.dimension);
  }
  return {fmt::format("sphere_{}", number), rows};
}

Table fraction_table(const MeasureReport& r) {
  const std::string pressure = r.dimension == 3 ? "Pa" : "N/m";
  Table t({{"diameter_from", "from", "m"},
           {"diameter_to", "to", "m"},
           {"particles"},
           {"solid_share", "solids", "-"},
           {"mean_stress_share", "stress", "-"},
           {"stress_ratio", "stress/solids", "-"},
           {"mean_stress", "mean stress", pressure},
           {"deviator", "deviator", pressure},
           {"coordination", "Z", "-"},
           {"mechanical_coordination", "Z_m", "-"},
           {"rattler_share", "rattlers", "-"}});
  for (const auto& f : r.fractions) {
    const Value to = std::isfinite(f.largest) ? Value(f.largest) : Value();
    t.add({f.smallest, to, whole(f.grains), f.solid_share, f.mean_stress_share, f.stress_ratio,
           mean_value(f.stress, r.dimension), deviator(f.stress, r.dimension), f.coordination,
           f.mechanical_coordination, f.rattler_share});
  }
  return t;
}

nlohmann::json histogram_json(const Histogram& h) {
  auto rows = nlohmann::json::array();
  for (std::size_t k = 0; k < h.count.size(); ++k)
    rows.push_back({{"middle", h.middle(k)}, {"count", h.count[k]}, {"density", h.density(k)}});
  return {{"bin_width", h.width}, {"below", h.below}, {"above", h.above}, {"bins", rows}};
}

nlohmann::json value_json(const Value& value) {
  if (const auto* number = std::get_if<double>(&value))
    return std::isfinite(*number) ? nlohmann::json(*number) : nlohmann::json();
  return std::get<std::int64_t>(value);
}

}  // namespace

void add_tensor(Rows& rows, const std::string& name, const std::string& unit, const Mat3& m, int dimension) {
  const auto add = [&](const char* axes, int k, int l) {
    rows.push_back({fmt::format("{}_{}", name, axes), unit, 0.5 * (m(k, l) + m(l, k))});
  };
  add("x", 0, 0), add("y", 1, 1);
  if (dimension == 3) add("z", 2, 2), add("yz", 1, 2), add("xz", 0, 2);
  add("xy", 0, 1);
}

MeasureReport measure_report(const Snapshot& packing, const std::string& name, std::span<const ContactPoint> contacts,
                             std::vector<double> splits, std::span<const MeasureSphere> spheres) {
  const Source s(packing, contacts);
  MeasureReport r;
  r.name = name, r.title = packing.scene.title, r.dimension = packing.state.dimension;
  r.connectivity = connectivity(s.state.grains.size(), contacts);
  r.forces = normal_forces(contacts);
  r.spins = spins(s.state);
  r.rose = r.dimension == 3 ? rose_3d(contacts) : rose_2d(contacts);
  if (splits.empty()) splits = natural_splits(s.state);
  r.fractions = size_fractions(s.state, contacts, s.h.volume, splits);
  r.pair_shares = stress_by_pair(s.state, contacts, splits);
  r.sections = {specimen_section(s), stress_section(s),  coordination_section(s, r.connectivity),
                fabric_section(s),   contact_section(s), motion_section(s, r.spins),
                energy_section(s)};
  for (std::size_t k = 0; k < spheres.size(); ++k) r.sections.push_back(sphere_section(s, spheres[k], k + 1));
  r.warnings = broken_assumptions(s.scene, s.state, s.h);
  return r;
}

std::string text_of(const MeasureReport& r) {
  std::string out = fmt::format("{}: {}\n", r.name, r.title);
  for (const auto& section : r.sections) {
    out += fmt::format("\n{}\n", section.key);
    for (const auto& row : section.rows) {
      const auto* number = std::get_if<double>(&row.value);
      out += fmt::format(
          "  {:<28}{} {}\n", row.key,
          number ? fmt::format("{:>13.6g}", *number) : fmt::format("{:>13}", std::get<std::int64_t>(row.value)),
          row.unit == "-" ? "" : row.unit);
    }
  }
  out += fmt::format("\nsize fractions\n{}", fraction_table(r).text());
  Table contacts({{"contacts"}, {"particles"}});
  for (std::size_t k = 0; k < r.connectivity.size(); ++k) contacts.add({whole(k), whole(r.connectivity[k])});
  out += fmt::format("\nparticles by number of contacts\n{}", contacts.text());
  for (const auto& warning : r.warnings) out += fmt::format("\nwarning: {}", warning);
  return out + (r.warnings.empty() ? "" : "\n");
}

nlohmann::json json_of(const MeasureReport& r) {
  nlohmann::json j{{"input", r.name}, {"title", r.title}, {"dimension", r.dimension}, {"warnings", r.warnings}};
  for (const auto& section : r.sections)
    for (const auto& row : section.rows) {
      j[section.key][row.key] = value_json(row.value);
      j["units"][section.key][row.key] = row.unit;
    }
  j["size_fractions"] = fraction_table(r).json();
  j["mean_stress_share_by_fractions"] = r.pair_shares;
  j["connectivity"] = r.connectivity;
  j["normal_force_over_mean"] = histogram_json(r.forces);
  j["spin_over_deviation"] = histogram_json(r.spins.scaled);
  j["rose"] = nlohmann::json::array();
  for (const auto& p : r.rose)
    j["rose"].push_back({{"azimuth", {p.azimuth_from, p.azimuth_to}},
                         {"height", {p.height_from, p.height_to}},
                         {"density", p.density},
                         {"force", p.force}});
  return j;
}

}  // namespace eg
