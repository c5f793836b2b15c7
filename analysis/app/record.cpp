#include "app/record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "boundary/cell_control.hpp"
#include "measure/homogenised.hpp"
#include "measure/stress.hpp"
#include "measure/tensor.hpp"

namespace eg {
namespace {

/// Largest rate of strain of the cell [1/s].
double strain_rate(const State& state) {
  double most = 0;
  for (const double r : state.cell.rate.a) most = std::max(most, std::abs(r));
  return most;
}

/// A stage driven by stress alone may run fast: its end is told by equilibrium, or is the user's business.
bool drives_strain(const StageSpec& stage) {
  return std::ranges::any_of(
      stage.control, [](const ComponentControl& c) { return c.kind == ComponentControl::Kind::rate && c.value != 0; });
}

double inertia(const Scene& scene, const State& state, double d50) {
  const double p = mean_stress(state), rate = strain_rate(state);
  return p > 0 && rate > 0 ? inertial_number(rate, d50, scene.materials.front().density, p) : 0.0;
}

}  // namespace

EnergyTable energies(const Scene& scene, const State& state, double kinetic) {
  EnergyTable t;
  visit_contacts(scene, state, [&](const ContactPoint& p) {
    t.normal += p.normal_energy;
    if (p.normal.tangential > 0) t.shear += 0.5 * dot(p.shear, p.shear) / p.normal.tangential;
  });
  const auto& e = state.ledger;
  t.kinetic = kinetic, t.friction = e.friction;
  t.path = e.shear_work - e.friction - t.shear;
  t.damping = e.local_damping + e.mass_damping + e.viscous_damping;
  t.work = e.boundary + e.body;
  t.residual = t.kinetic + t.normal + e.shear_work + t.damping - t.work;
  return t;
}

std::vector<HistoryColumn> history_columns(const Scene& scene) {
  const std::string stress = scene.dimension == 3 ? "Pa" : "N/m", joule = scene.dimension == 3 ? "J" : "J/m";
  std::vector<HistoryColumn> c{{"stage", "-"}, {"time", "s"}, {"dt", "s"}, {"dt_certified", "s"}};
  const std::vector<std::string> axes = scene.dimension == 3 ? std::vector<std::string>{"x", "y", "z", "yz", "xz", "xy"}
                                                             : std::vector<std::string>{"x", "y", "xy"};
  for (const auto& a : axes) c.push_back({"strain_" + a, "-"});
  for (const auto& a : axes) c.push_back({"stress_" + a, stress});
  for (const auto& [name, unit] :
       std::initializer_list<std::pair<const char*, std::string>>{{"mean_stress", stress},
                                                                  {"deviator", stress},
                                                                  {"void_ratio", "-"},
                                                                  {"coordination", "-"},
                                                                  {"mechanical_coordination", "-"},
                                                                  {"sliding_fraction", "-"},
                                                                  {"largest_overlap", "-"},
                                                                  {"inertial_number", "-"},
                                                                  {"unbalanced_force", "-"},
                                                                  {"kinetic_energy", joule}})
    c.push_back({name, unit});
  if (scene.energy)
    for (const char* name : {"elastic_normal", "elastic_shear", "friction_work", "shear_path_work", "damping_work",
                             "outside_work", "energy_residual"})
      c.push_back({name, joule});
  return c;
}

std::vector<double> history_row(const Scene& scene, const State& state, const RunStatus& status) {
  const Homogenised h = homogenise(scene, state);
  const auto strain = stage_strain(state), stress = stress_components(state);
  std::vector<double> row{static_cast<double>(state.stage + 1), state.time, state.dt, state.policy.safe};
  const std::vector<std::size_t> axes =
      scene.dimension == 3 ? std::vector<std::size_t>{0, 1, 2, 3, 4, 5} : std::vector<std::size_t>{0, 1, 5};
  for (const auto k : axes) row.push_back(strain[k]);
  for (const auto k : axes) row.push_back(stress[k]);
  row.insert(row.end(), {mean_stress(state), deviator(contact_stress(state), scene.dimension), h.void_ratio,
                         h.coordination.mean, h.coordination.mechanical, h.sliding_fraction, h.largest_overlap,
                         inertia(scene, state, h.sizes.d50), status.unbalanced, status.kinetic});
  if (scene.energy) {
    const EnergyTable e = energies(scene, state, status.kinetic);
    row.insert(row.end(), {e.normal, e.shear, e.friction, e.path, e.damping, e.work, e.residual});
  }
  return row;
}

std::vector<std::string> broken_assumptions(const Scene& scene, const State& state, const RunStatus& status) {
  std::vector<std::string> out;
  const Homogenised h = homogenise(scene, state);
  if (h.largest_overlap > 0.05)
    out.push_back(fmt::format(
        "largest overlap {:.2f} % of the smaller diameter (limit 5 %): contacts are too soft for this stress",
        100 * h.largest_overlap));
  const double i = inertia(scene, state, h.sizes.d50);
  if (i > 2.5e-3 && drives_strain(status.stage))
    out.push_back(fmt::format("inertial number {:.2e} (limit 2.5e-3): not quasi-static", i));
  if (state.policy.safe > 0 && state.dt > state.policy.safe * (1 + 1e-12))
    out.push_back(fmt::format("time step {:.4g} s is {:.2f} times the certified limit {:.4g} s: it may be unstable",
                              state.dt, state.dt / state.policy.safe, state.policy.safe));
  if (scene.energy && scene.specimen.source == SpecimenSpec::Source::cloud) {  // others may begin with stored energy
    const EnergyTable e = energies(scene, state, status.kinetic);
    if (std::abs(e.residual) > 0.01 * std::abs(e.work))
      out.push_back(fmt::format("energy drift {:.2e} J is {:.1f} % of the work done (limit 1 %)", e.residual,
                                100 * std::abs(e.residual / e.work)));
  }
  return out;
}

}  // namespace eg
