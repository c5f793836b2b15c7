#include "app/record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "boundary/body_control.hpp"
#include "boundary/cell_control.hpp"
#include "dynamics/bonds.hpp"
#include "measure/stress.hpp"
#include "measure/tensor.hpp"

namespace eg {
namespace {

/// A stage driven by stress alone may run fast: its end is told by equilibrium, or is the user's business.
bool drives_strain(const StageSpec& stage) {
  return std::ranges::any_of(stage.control, [](const ComponentControl& c) {
    using Kind = ComponentControl::Kind;
    return (c.kind == Kind::rate || c.kind == Kind::inertial) && c.value != 0;
  });
}

/// All that the columns of a row are taken from.
struct RowSource {
  const Scene& scene;
  const State& state;
  const Homogenised& h;
  std::array<double, 6> strain, stress;
  EnergyTable energy;
};

/// A column of the history and where its value comes from: the one list of what a history holds.
struct RowColumn {
  HistoryColumn head;
  std::function<double(const RowSource&)> value;
};
using Columns = std::vector<RowColumn>;

void add_run_columns(Columns& c) {
  c.push_back({{"stage", "-"}, [](const RowSource& r) { return static_cast<double>(r.state.stage + 1); }});
  c.push_back({{"time", "s"}, [](const RowSource& r) { return r.state.time; }});
  c.push_back({{"dt", "s"}, [](const RowSource& r) { return r.state.dt; }});
  c.push_back({{"dt_certified", "s"}, [](const RowSource& r) { return r.state.policy.safe; }});
  c.push_back({{"step_cause", "-"}, [](const RowSource& r) { return static_cast<double>(r.state.policy.cause); }});
}

void add_stress_columns(Columns& c, int dimension, const std::string& pressure) {
  constexpr std::array<const char*, 6> names{"x", "y", "z", "yz", "xz", "xy"};
  const std::vector<std::size_t> axes =
      dimension == 3 ? std::vector<std::size_t>{0, 1, 2, 3, 4, 5} : std::vector<std::size_t>{0, 1, 5};
  for (const auto k : axes)
    c.push_back({{std::string("strain_") + names[k], "-"}, [k](const RowSource& r) { return r.strain[k]; }});
  for (const auto k : axes)
    c.push_back({{std::string("stress_") + names[k], pressure}, [k](const RowSource& r) { return r.stress[k]; }});
  c.push_back({{"mean_stress", pressure}, [](const RowSource& r) { return mean_stress(r.state); }});
  c.push_back({{"deviator", pressure},
               [](const RowSource& r) { return deviator(contact_stress(r.state), r.scene.dimension); }});
  for (std::size_t k = 0; k < static_cast<std::size_t>(dimension); ++k)
    c.push_back({{fmt::format("stress_{}", k + 1), pressure}, [k, dimension](const RowSource& r) {
                   return principal(contact_stress(r.state), dimension).values[k];
                 }});
}

void add_fabric_columns(Columns& c, int dimension) {
  for (std::size_t k = 0; k < static_cast<std::size_t>(dimension); ++k)
    c.push_back(
        {{fmt::format("fabric_{}", k + 1), "-"}, [k](const RowSource& r) { return r.h.fabric_axes.values[k]; }});
  c.push_back(
      {{"fabric_deviator", "-"}, [dimension](const RowSource& r) { return anisotropy(r.h.fabric_axes, dimension); }});
  c.push_back({{"force_fabric_deviator", "-"},
               [dimension](const RowSource& r) { return anisotropy(r.h.force_fabric_axes, dimension); }});
}

void add_network_columns(Columns& c, const std::string& joule) {
  c.push_back({{"void_ratio", "-"}, [](const RowSource& r) { return r.h.void_ratio; }});
  c.push_back({{"coordination", "-"}, [](const RowSource& r) { return r.h.coordination.mean; }});
  c.push_back({{"mechanical_coordination", "-"}, [](const RowSource& r) { return r.h.coordination.mechanical; }});
  c.push_back({{"rattler_share", "-"}, [](const RowSource& r) { return rattler_share(r.h.coordination); }});
  c.push_back({{"sliding_fraction", "-"}, [](const RowSource& r) { return r.h.sliding_fraction; }});
  c.push_back({{"mobilised_friction", "-"}, [](const RowSource& r) { return r.h.forces.mobilised_friction; }});
  c.push_back({{"mean_contact_force", "N"}, [](const RowSource& r) { return r.h.forces.mean_force; }});
  c.push_back({{"strong_contact_share", "-"}, [](const RowSource& r) { return r.h.forces.strong_contacts; }});
  c.push_back({{"normal_deviator_share", "-"}, [](const RowSource& r) { return r.h.normal_share; }});
  c.push_back({{"largest_overlap", "-"}, [](const RowSource& r) { return r.h.largest_overlap; }});
  c.push_back({{"inertial_number", "-"}, [](const RowSource& r) { return inertial_number_of(r.scene, r.state, r.h); }});
  c.push_back({{"unbalanced_force", "-"}, [](const RowSource& r) { return r.state.unbalanced; }});
  c.push_back({{"kinetic_energy", joule}, [](const RowSource& r) { return r.state.kinetic; }});
}

void add_bond_columns(Columns& c) {
  c.push_back({{"bonds", "-"}, [](const RowSource& r) { return static_cast<double>(intact_bonds(r.state)); }});
  c.push_back({{"bonds_pulled", "-"}, [](const RowSource& r) { return static_cast<double>(r.state.bonds.pulled); }});
  c.push_back({{"bonds_cut", "-"}, [](const RowSource& r) { return static_cast<double>(r.state.bonds.cut); }});
}

void add_energy_columns(Columns& c, const std::string& joule) {
  c.push_back({{"elastic_normal", joule}, [](const RowSource& r) { return r.energy.normal; }});
  c.push_back({{"elastic_shear", joule}, [](const RowSource& r) { return r.energy.shear; }});
  c.push_back({{"friction_work", joule}, [](const RowSource& r) { return r.energy.friction; }});
  c.push_back({{"shear_path_work", joule}, [](const RowSource& r) { return r.energy.path; }});
  c.push_back({{"damping_work", joule}, [](const RowSource& r) { return r.energy.damping; }});
  c.push_back({{"outside_work", joule}, [](const RowSource& r) { return r.energy.work; }});
  c.push_back({{"energy_residual", joule}, [](const RowSource& r) { return r.energy.residual; }});
}

/// Of a stack of rings: how far its rings stand out of balance, and how far the furthest has gone.
void add_stack_columns(Columns& c, const Scene& scene, const std::string& group) {
  const auto over = [&scene, group](const State& state, auto&& visit) {
    for (std::size_t b = 0; b < state.bodies.size(); ++b)
      if (scene.boundary.bodies[b].group == group) visit(state.bodies[b]);
  };
  c.push_back({{group + "_resultant_share", "-"}, [over](const RowSource& r) {
                 double resultants = 0, forces = 0;
                 over(r.state, [&](const Body& b) {
                   Vec3 free = b.force;
                   for (int k = 0; k < 3; ++k)
                     if (!b.free[static_cast<std::size_t>(k)]) free[k] = 0;
                   resultants += norm(free), forces += b.magnitude;
                 });
                 return forces > 0 ? resultants / forces : 0.0;
               }});
  c.push_back({{group + "_largest_displacement", "m"}, [over](const RowSource& r) {
                 double most = 0;
                 over(r.state, [&](const Body& b) { most = std::max(most, norm(b.moved)); });
                 return most;
               }});
}

/// What each part of the apparatus feels (force of the grains on it) and how far it has gone since the stage began.
void add_body_columns(Columns& c, const Scene& scene) {
  const auto& bodies = scene.boundary.bodies;
  const std::string pressure = scene.dimension == 3 ? "Pa" : "N/m";
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (!bodies[b].group.empty()) {
      if (b == 0 || bodies[b - 1].group != bodies[b].group) add_stack_columns(c, scene, bodies[b].group);
      continue;
    }
    for (int k = 0; k < scene.dimension; ++k) {
      const std::string axis(1, "xyz"[k]);
      c.push_back({{bodies[b].name + "_force_" + axis, "N"},
                   [b, k](const RowSource& r) { return r.state.bodies[b].force[k]; }});
      c.push_back({{bodies[b].name + "_moved_" + axis, "m"},
                   [b, k](const RowSource& r) { return r.state.bodies[b].moved[k]; }});
    }
    c.push_back({{bodies[b].name + "_stress", pressure}, [b](const RowSource& r) {
                   return body_load(r.scene, r.state, drive_of(r.scene, r.state, b)).stress();
                 }});
    if (scene.boundary.membrane)
      c.push_back({{bodies[b].name + "_outer_stress", pressure},
                   [b](const RowSource& r) { return outer_stress(r.scene, r.state, b); }});
    const bool looks_inside = std::ranges::any_of(scene.stages, [b](const StageSpec& s) {
      return std::ranges::any_of(s.bodies, [b](const BodyDrive& d) { return d.body == b && d.region; });
    });
    if (looks_inside)
      c.push_back({{bodies[b].name + "_region_stress", pressure},
                   [b](const RowSource& r) { return r.state.bodies[b].inside; }});
    const bool round = std::ranges::any_of(
        scene.boundary.walls, [b](const WallSpec& w) { return w.body == b && w.shape == WallSpec::Shape::cylinder; });
    if (round)
      c.push_back({{bodies[b].name + "_opened", "m"}, [b](const RowSource& r) { return r.state.bodies[b].opened; }});
  }
}

void add_membrane_columns(Columns& c, int dimension) {
  const bool solid = dimension == 3;
  c.push_back({{"membrane_stress", solid ? "Pa" : "N/m"}, [](const RowSource& r) { return r.state.membrane.stress; }});
  c.push_back({{"membrane_area", solid ? "m2" : "m"}, [](const RowSource& r) { return r.state.membrane.area; }});
  c.push_back({{"membrane_volume", solid ? "m3" : "m2"}, [](const RowSource& r) { return r.state.membrane.volume; }});
}

Columns columns_of(const Scene& scene) {
  const std::string joule = scene.dimension == 3 ? "J" : "J/m";
  Columns c;
  add_run_columns(c);
  add_stress_columns(c, scene.dimension, scene.dimension == 3 ? "Pa" : "N/m");
  add_network_columns(c, joule);
  add_fabric_columns(c, scene.dimension);
  add_body_columns(c, scene);
  if (std::ranges::any_of(scene.stages, [](const StageSpec& s) { return s.bond.has_value(); })) add_bond_columns(c);
  if (scene.boundary.membrane) add_membrane_columns(c, scene.dimension);
  if (scene.energy) add_energy_columns(c, joule);
  return c;
}

}  // namespace

const StageSpec& current_stage(const Scene& scene, const State& state) {
  static const StageSpec none;
  return scene.stages.empty() ? none : scene.stages[std::min(state.stage, scene.stages.size() - 1)];
}

double inertial_number_of(const Scene& scene, const State& state, const Homogenised& h) {
  const double p = mean_stress(state), rate = driving_rate(state, current_stage(scene, state));
  return p > 0 && rate > 0 ? inertial_number(rate, h.sizes.d50, scene.materials.front().density, p) : 0.0;
}

EnergyTable energies(const Scene& scene, const State& state) {
  EnergyTable t;
  visit_contacts(scene, state, [&](const ContactPoint& p) { t.normal += p.normal_energy, t.shear += p.shear_energy; });
  const auto& e = state.ledger;
  t.kinetic = state.kinetic, t.friction = e.friction;
  t.path = e.shear_work - e.friction - t.shear;
  t.damping = e.local_damping + e.mass_damping + e.viscous_damping;
  t.work = e.boundary + e.body;
  t.residual = t.kinetic + t.normal + e.shear_work + t.damping - t.work;
  return t;
}

std::vector<HistoryColumn> step_columns() {
  return {{"time", "s"},           {"dt", "s"},    {"dt_certified", "s"},
          {"dt_limit_upper", "s"}, {"cause", "-"}, {"cost_share", "-"}};
}

std::vector<double> step_row(const State& state, double share) {
  const StepPlan& p = state.policy;
  return {state.time, p.dt, p.safe, p.unsafe, static_cast<double>(p.cause), share};
}

std::vector<HistoryColumn> history_columns(const Scene& scene) {
  std::vector<HistoryColumn> heads;
  for (const auto& column : columns_of(scene)) heads.push_back(column.head);
  return heads;
}

std::vector<double> history_row(const Scene& scene, const State& state, const Homogenised& h) {
  const RowSource source{scene,
                         state,
                         h,
                         stage_strain(state),
                         stress_components(state),
                         scene.energy ? energies(scene, state) : EnergyTable{}};
  std::vector<double> row;
  for (const auto& column : columns_of(scene)) row.push_back(column.value(source));
  return row;
}

std::vector<std::string> broken_assumptions(const Scene& scene, const State& state, const Homogenised& h) {
  std::vector<std::string> out;
  if (h.largest_overlap > 0.05)
    out.push_back(fmt::format(
        "largest overlap {:.2f} % of the smaller diameter (limit 5 %): contacts are too soft for this stress",
        100 * h.largest_overlap));
  const double i = inertial_number_of(scene, state, h);
  if (i > 2.5e-3 && drives_strain(current_stage(scene, state)))
    out.push_back(fmt::format("inertial number {:.2e} (limit 2.5e-3): not quasi-static", i));
  if (state.policy.safe > 0 && state.dt > state.policy.safe * (1 + 1e-12))
    out.push_back(fmt::format("time step {:.4g} s is {:.2f} times the certified limit {:.4g} s: it may be unstable",
                              state.dt, state.dt / state.policy.safe, state.policy.safe));
  if (scene.energy && scene.specimen.source == SpecimenSpec::Source::cloud) {  // others may begin with stored energy
    const EnergyTable e = energies(scene, state);
    if (std::abs(e.residual) > 0.01 * std::abs(e.work))
      out.push_back(fmt::format("energy drift {:.2e} J is {:.1f} % of the work done (limit 1 %)", e.residual,
                                100 * std::abs(e.residual / e.work)));
  }
  return out;
}

}  // namespace eg
