#include "io/stage_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "contact/laws.hpp"
#include "io/boundary_reader.hpp"
#include "state/drive.hpp"

namespace eg {

namespace {

using Kind = ComponentControl::Kind;
using Quantity = CellCondition::Quantity;
const std::array<std::string, 6> component_names{"x", "y", "z", "yz", "xz", "xy"};

std::vector<std::string> names_in(int dimension) {
  std::vector<std::string> names;
  for (std::size_t k = 0; k < 6; ++k)
    if (component_exists(k, dimension)) names.push_back(component_names[k]);
  return names;
}

std::size_t component(const std::string& name) {
  return static_cast<std::size_t>(std::ranges::find(component_names, name) - component_names.begin());
}

/// The components of a stage and which of them the file has driven so far.
struct Drivers {
  StageSpec& stage;
  int dimension;
  std::array<bool, 6> driven{};

  void set(const TomlReader& t, const std::string& key, std::size_t component, ComponentControl control) {
    if (driven[component])
      throw t.error(key, "drives a component that is driven already", "give each component one stress or one rate");
    driven[component] = true;
    stage.control[component] = control;
  }
};

/// Numbers by component name; 2D scenes have no others.
bool component_number(const TomlReader& t, std::size_t k, int dimension, const Range& range, double& value) {
  const auto& key = component_names[k];
  if (component_exists(k, dimension)) return t.number(key, value, range);
  if (t.has(key)) throw t.error(key, "is not a component of a 2D scene", "a 2D scene has x, y and xy");
  return false;
}

/// stress = { … } or strain_rate = { … }: `isotropic` stands for every axis.
void read_components(const TomlReader& t, Kind kind, const Range& axis_range, Drivers& drivers) {
  double value = 0;
  if (t.number("isotropic", value, axis_range))
    for (std::size_t k = 0; k < 3; ++k)
      if (component_exists(k, drivers.dimension)) drivers.set(t, "isotropic", k, {kind, value});
  for (std::size_t k = 0; k < 6; ++k)
    if (component_number(t, k, drivers.dimension, k < 3 ? axis_range : any_number, value))
      drivers.set(t, component_names[k], k, {kind, value});
}

/// strain_rate = { axis = "z", inertial_number = 1e-3 } beside rates of other components.
void read_inertial(const TomlReader& t, Drivers& drivers) {
  std::string axis;
  double number = 0;
  const bool named = t.choice("axis", axis, names_in(drivers.dimension)), given = t.number("inertial_number", number);
  if (named != given)
    throw t.error(named ? "axis" : "inertial_number",
                  named ? "needs an inertial_number beside it" : "needs an axis beside it",
                  "for example { axis = \"z\", inertial_number = 1e-3 }");
  if (named) drivers.set(t, "axis", component(axis), {Kind::inertial, number});
}

Components axes_weighted(double x, double y, double z) { return {x, y, z, 0, 0, 0}; }

/// σz − (σx + σy)/2, 2D: σy − σx.
Components deviator_weights(int dimension) {
  return dimension == 3 ? axes_weighted(-0.5, -0.5, 1) : axes_weighted(-1, 1, 0);
}

/// combinations = [{ stress = { z = 1, x = -2 }, value = 0 }, { strain_rate = { … }, value = … }]
CellCondition read_combination(const TomlReader& t, int dimension) {
  CellCondition condition;
  const auto stress = t.table("stress"), rate = t.table("strain_rate");
  if (stress.has_value() == rate.has_value())
    throw t.error("", "must weigh either stresses or strain rates",
                  "for example { stress = { z = 1, x = -2 }, value = 0 }");
  condition.quantity = stress ? Quantity::stress : Quantity::rate;
  const TomlReader& weights = stress ? *stress : *rate;
  for (std::size_t k = 0; k < 6; ++k) component_number(weights, k, dimension, any_number, condition.coefficient[k]);
  weights.finish();
  t.number("value", condition.value, any_number, Need::required);
  t.finish();
  return condition;
}

/// Axes that strain alike: a rate condition for all but the first.
std::vector<std::size_t> read_equal(const TomlReader& t, const Drivers& drivers) {
  const std::vector<std::string> axes(component_names.begin(), component_names.begin() + drivers.dimension);
  std::vector<std::string> names;
  std::vector<std::size_t> equal;
  if (!t.choices("equal", names, axes)) return equal;
  if (names.empty()) throw t.error("equal", "must name at least one axis", "for example equal = [\"x\", \"y\"]");
  for (const auto& name : names) {
    if (drivers.driven[component(name)] || std::ranges::count(names, name) > 1)
      throw t.error("equal", "drives a component that is driven already", "give each component one stress or one rate");
    equal.push_back(component(name));
  }
  for (std::size_t n = 1; n < equal.size(); ++n) {
    CellCondition alike;
    alike.coefficient[equal[0]] = 1, alike.coefficient[equal[n]] = -1;
    drivers.stage.hold.push_back(alike);
  }
  return equal;
}

/// Which components the conditions decide: all that they weigh and nothing else drives, or, if those are too many, the
/// ones that are to strain alike.
void free_components(const TomlReader& t, const std::vector<std::size_t>& equal, Drivers& drivers) {
  StageSpec& stage = drivers.stage;
  std::vector<std::size_t> weighed;
  for (std::size_t k = 0; k < 6; ++k)
    if (!drivers.driven[k] && std::ranges::any_of(stage.hold, [k](const auto& c) { return c.coefficient[k] != 0; }))
      weighed.push_back(k);
  const auto& free = weighed.size() != stage.hold.size() && equal.size() == stage.hold.size() ? equal : weighed;
  if (free.size() != stage.hold.size()) {
    std::string names;
    for (const auto k : free) names += (names.empty() ? "" : ", ") + component_names[k];
    throw t.error("",
                  fmt::format("makes {} condition{} for {} component{} that nothing else drives ({})",
                              stage.hold.size(), stage.hold.size() == 1 ? "" : "s", free.size(),
                              free.size() == 1 ? "" : "s", names.empty() ? "none" : names),
                  "there must be one for each: add conditions, or drive components by stress or strain_rate");
  }
  for (const auto k : free) stage.control[k] = {Kind::free, 0};
  if (!Drive(stage, drivers.dimension).solvable())
    throw t.error("", "holds conditions that contradict each other or say the same twice",
                  "each must add something that the others leave open");
}

void read_hold(const TomlReader& t, Drivers& drivers) {
  const int dimension = drivers.dimension;
  const auto add = [&](Quantity quantity, const Components& weights, double value) {
    drivers.stage.hold.push_back({quantity, weights, value});
  };
  double value = 0;
  if (t.number("mean_stress", value, positive))
    add(Quantity::stress, dimension == 3 ? axes_weighted(1. / 3, 1. / 3, 1. / 3) : axes_weighted(0.5, 0.5, 0), value);
  if (t.number("deviator", value)) add(Quantity::stress, deviator_weights(dimension), value);
  if (dimension == 3 && t.number("b", value, closed(0, 1)))  // (σy − σx) − b (σz − σx) = 0
    add(Quantity::stress, axes_weighted(value - 1, 1, -value), 0);
  if (t.number("volume_rate", value)) add(Quantity::rate, axes_weighted(1, 1, dimension == 3 ? 1 : 0), value);
  const auto equal = read_equal(t, drivers);
  for (const auto& c : t.tables("combinations")) drivers.stage.hold.push_back(read_combination(c, dimension));
  t.finish();
  if (drivers.stage.hold.empty())
    throw t.error("", "names no condition", "give mean_stress, deviator, b, volume_rate, equal or combinations");
  free_components(t, equal, drivers);
}

CycleSpec read_cycle(const TomlReader& t, const Drivers& drivers) {
  CycleSpec cycle;
  std::string stress, strain;
  auto names = names_in(drivers.dimension);
  const bool by_strain = t.choice("strain", strain, names);
  names.push_back("deviator");
  const bool by_stress = t.choice("stress", stress, names);
  if (by_stress == by_strain)
    throw t.error("", "must run between limits of either a stress or a strain",
                  "for example { stress = \"deviator\", mean = 0, amplitude = 20e3 }");
  cycle.quantity = by_stress ? CycleSpec::Quantity::stress : CycleSpec::Quantity::strain;
  if (stress == "deviator")
    cycle.coefficient = deviator_weights(drivers.dimension);
  else
    cycle.coefficient[component(by_stress ? stress : strain)] = 1;
  t.number("mean", cycle.mean);
  t.number("amplitude", cycle.amplitude, positive, Need::required);
  t.number("largest_strain", cycle.largest_strain, positive);
  t.finish();
  return cycle;
}

void read_until(const TomlReader& t, StageSpec& stage) {
  const bool error = t.number("stress_error", stage.until_stress_error, open(0, 1));
  bool any = error;
  any |= t.number("unbalanced_force", stage.until_unbalanced, open(0, 1));
  any |= t.number("time", stage.until_time, positive);
  any |= t.integer("steps", stage.until_steps, counting);
  any |= t.number("axial_strain", stage.until_axial_strain, positive);
  any |= t.number("shear_strain", stage.until_shear_strain, positive);
  any |= t.number("displacement", stage.until_displacement, positive);
  const bool cycles = t.integer("cycles", stage.until_cycles, counting);
  t.finish();
  if (!any && !cycles)
    throw t.error(
        "", "names no condition",
        "give at least one of stress_error, unbalanced_force, time, steps, axial_strain, shear_strain, displacement, "
        "cycles");
  const bool aims = std::ranges::any_of(stage.control, [](const auto& c) { return c.kind == Kind::stress; }) ||
                    std::ranges::any_of(stage.hold, [](const auto& c) { return c.quantity == Quantity::stress; }) ||
                    std::ranges::any_of(stage.bodies, [](const auto& b) { return b.servo != BodyDrive::Servo::none; });
  if (error && !aims)
    throw t.error("stress_error", "needs a stress that is aimed at",
                  "add stress or hold to the stage, or a servo to a body");
  if (cycles && !stage.cycle) throw t.error("cycles", "needs a cycle to count", "add cycle = { … } to the stage");
}

void read_record(const TomlReader& t, StageSpec& stage) {
  t.integer("every_steps", stage.record_every_steps, counting);
  t.number("every_strain", stage.record_every_strain, positive);
  t.number("every_displacement", stage.record_every_displacement, positive);
  t.integer("snapshot_every_steps", stage.snapshot_every_steps, counting);
  t.number("snapshot_every_displacement", stage.snapshot_every_displacement, positive);
  t.flag("snapshot_at_end", stage.snapshot_at_end);
  t.finish();
}

void read_bond(const TomlReader& t, const Scene& scene, StageSpec& stage) {
  BondSpec bond;
  t.number("gap", bond.gap, non_negative, Need::required);
  t.integer("clusters", bond.clusters, counting);
  t.finish();
  bool bonds = false;
  with_law(scene.contact.law, [&]<class Law>(Law) { bonds = HasBonds<Law>; });
  if (!bonds)
    throw t.error("", fmt::format("needs a law with bonds, which \"{}\" is not", scene.contact.law),
                  "set contact.law = \"linear-parallel-bond\"");
  stage.bond = bond;
}

ShakeSpec read_shake(const TomlReader& t, int dimension) {
  ShakeSpec shake;
  t.vector("acceleration", dimension, shake.acceleration, Need::required);
  t.number("frequency", shake.frequency, positive, Need::required);
  t.finish();
  return shake;
}

/// friction = { start = …, void_ratio = … } or { start = …, mean_stress = … }
void read_friction_schedule(const TomlReader& t, StageSpec& stage) {
  double start = 0;
  FrictionSchedule schedule;
  t.number("start", start, positive, Need::required);
  const bool volume = t.number("void_ratio", schedule.void_ratio, positive);
  if (t.number("mean_stress", schedule.mean_stress, positive) == volume)
    throw t.error("", "must aim at either a void_ratio or a mean_stress",
                  "for example { start = 0.5, void_ratio = 0.6 }");
  t.finish();
  stage.friction = start, stage.friction_schedule = schedule;
}

/// friction = { MATERIAL = …, … }
void read_material_friction(const TomlReader& t, const Scene& scene, StageSpec& stage) {
  for (const Material& m : scene.materials) {
    auto& friction = stage.material_friction.emplace_back();
    t.number(m.name, friction, non_negative);
  }
  t.finish();
}

/// What a stage that changes its grains needs beside it.
void check_preparation(const TomlReader& t, const Scene& scene, const StageSpec& stage) {
  if (stage.friction_schedule && std::isnan(stage.until_unbalanced))
    throw t.error("friction", "falls whenever the packing is at rest, but until names no rest",
                  "add unbalanced_force to until");
  if (!(stage.radius_growth > 0)) return;
  if (std::isnan(scene.specimen.expand_to))
    throw t.error("radius_growth", "finds radii that have their sizes already", "add expand_to to [specimen]");
  if (scene.energy)
    throw t.error("radius_growth", "does work that the energy ledger does not know", "remove record.energy");
}

void check_cell(const TomlReader& t, const Scene& scene) {
  if (scene.boundary.kind == BoundarySpec::Kind::periodic) {
    for (const char* key : {"shake", "held_above"})
      if (t.has(key)) throw t.error(key, "needs a container", "set boundary.type = \"box\" or \"free\"");
    return;
  }
  if (t.is_table("friction") && t.table("friction")->has("start"))
    throw t.error("friction", "as a schedule needs a periodic cell", "give a number");
  for (const char* key : {"stress", "strain_rate", "hold", "cycle"})
    if (t.has(key)) throw t.error(key, "needs a periodic cell", "set boundary.type = \"periodic\"");
  const auto until = t.table("until", Need::required);
  for (const char* key : {"axial_strain", "shear_strain"})
    if (until->has(key)) throw until->error(key, "needs a periodic cell", "use time, steps or displacement");
}

}  // namespace

StageSpec read_stage(const TomlReader& t, const Scene& scene) {
  StageSpec stage;
  t.name("name", stage.name, Need::required);
  check_cell(t, scene);
  if (const auto friction = t.is_table("friction") ? t.table("friction") : std::nullopt)
    friction->has("start") ? read_friction_schedule(*friction, stage) : read_material_friction(*friction, scene, stage);
  else
    t.number("friction", stage.friction, non_negative);
  t.number("radius_growth", stage.radius_growth, positive);
  t.number("local_damping", stage.local_damping, from_below(0, 1));
  if (const auto shake = t.table("shake")) stage.shake = read_shake(*shake, scene.dimension);
  t.number("held_above", stage.held_above);
  if (const auto bond = t.table("bond")) read_bond(*bond, scene, stage);
  t.number("max_strain_rate", stage.max_strain_rate, positive);
  t.integer("max_steps", stage.max_steps, counting);

  Drivers drivers{stage, scene.dimension};
  const auto stress = t.table("stress"), rate = t.table("strain_rate"), hold = t.table("hold");
  if (stress) read_components(*stress, Kind::stress, positive, drivers), stress->finish();
  if (rate) read_components(*rate, Kind::rate, any_number, drivers), read_inertial(*rate, drivers), rate->finish();
  if (hold) read_hold(*hold, drivers);
  if (const auto cycle = t.table("cycle")) stage.cycle = read_cycle(*cycle, drivers);
  read_bodies(t, scene, stage);
  const auto until = *t.table("until", Need::required);
  read_until(until, stage);
  if (stage.until_displacement > 0 && scene.boundary.bodies.empty())
    throw until.error("displacement", "needs a body that moves", "use time, steps or a strain, or add walls");
  if (const auto record = t.table("record")) read_record(*record, stage);
  t.finish();
  check_preparation(t, scene, stage);
  return stage;
}

}  // namespace eg
