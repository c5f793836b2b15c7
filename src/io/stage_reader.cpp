#include "io/stage_reader.hpp"

#include <cmath>

namespace eg {

namespace {

using Kind = ComponentControl::Kind;
const std::array<std::string, 6> component_names{"x", "y", "z", "yz", "xz", "xy"};

bool exists(std::size_t component, int dimension) { return dimension == 3 || component <= 1 || component == 5; }

/// The components of a stage and which of them the file has driven so far.
struct Drive {
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

/// stress = { … } or strain_rate = { … }: `isotropic` stands for every axis.
void read_components(const TomlReader& t, Kind kind, const Range& axis_range, Drive& drive) {
  double value = 0;
  if (t.number("isotropic", value, axis_range))
    for (std::size_t k = 0; k < 3; ++k)
      if (exists(k, drive.dimension)) drive.set(t, "isotropic", k, {kind, value});
  for (std::size_t k = 0; k < 6; ++k) {
    const auto& key = component_names[k];
    if (exists(k, drive.dimension)) {
      if (t.number(key, value, k < 3 ? axis_range : any_number)) drive.set(t, key, k, {kind, value});
    } else if (t.has(key)) {
      throw t.error(key, "is not a component of a 2D scene", "a 2D scene has x, y and xy");
    }
  }
  t.finish();
}

void read_hold(const TomlReader& t, Drive& drive) {
  StageSpec& stage = drive.stage;
  t.number("mean_stress", stage.mean_stress, positive);
  if (!stage.mean_stress) throw t.error("", "needs mean_stress", "add mean_stress = STRESS in Pa");
  const std::vector<std::string> axes(component_names.begin(), component_names.begin() + drive.dimension);
  std::vector<std::string> equal;
  t.choices("equal", equal, axes, Need::required);
  if (equal.empty()) throw t.error("equal", "must name at least one axis", "for example equal = [\"x\", \"y\"]");
  for (const auto& axis : equal) {
    const auto k = static_cast<std::size_t>(axis[0] - 'x');
    drive.set(t, "equal", k, {Kind::stress, *stage.mean_stress});
    stage.mean_axes[k] = true;
  }
  t.finish();
}

void read_until(const TomlReader& t, StageSpec& stage, bool servo) {
  const bool error = t.number("stress_error", stage.until_stress_error, open(0, 1));
  bool any = error;
  any |= t.number("unbalanced_force", stage.until_unbalanced, open(0, 1));
  any |= t.number("time", stage.until_time, positive);
  any |= t.integer("steps", stage.until_steps, counting);
  any |= t.number("axial_strain", stage.until_axial_strain, positive);
  t.finish();
  if (!any)
    throw t.error("", "names no condition",
                  "give at least one of stress_error, unbalanced_force, time, steps, axial_strain");
  if (error && !servo)
    throw t.error("stress_error", "needs a stress that is aimed at", "add stress or hold to the stage");
}

void read_record(const TomlReader& t, StageSpec& stage) {
  t.integer("every_steps", stage.record_every_steps, counting);
  t.number("every_strain", stage.record_every_strain, positive);
  t.integer("snapshot_every_steps", stage.snapshot_every_steps, counting);
  t.finish();
}

void check_cell(const TomlReader& t, const Scene& scene) {
  if (scene.boundary.kind == BoundarySpec::Kind::periodic) return;
  for (const char* key : {"stress", "strain_rate", "hold"})
    if (t.has(key)) throw t.error(key, "needs a periodic cell", "set boundary.type = \"periodic\"");
  const auto until = t.table("until", Need::required);
  if (until->has("axial_strain")) throw until->error("axial_strain", "needs a periodic cell", "use time or steps");
}

}  // namespace

StageSpec read_stage(const TomlReader& t, const Scene& scene) {
  StageSpec stage;
  t.name("name", stage.name, Need::required);
  check_cell(t, scene);
  t.number("friction", stage.friction, non_negative);
  t.number("local_damping", stage.local_damping, from_below(0, 1));
  t.number("max_strain_rate", stage.max_strain_rate, positive);
  t.integer("max_steps", stage.max_steps, counting);

  Drive drive{stage, scene.dimension};
  const auto stress = t.table("stress"), rate = t.table("strain_rate"), hold = t.table("hold");
  if (stress) read_components(*stress, Kind::stress, positive, drive);
  if (rate) read_components(*rate, Kind::rate, any_number, drive);
  if (hold) read_hold(*hold, drive);
  read_until(*t.table("until", Need::required), stage, stress || hold);
  if (const auto record = t.table("record")) read_record(*record, stage);
  t.finish();
  return stage;
}

}  // namespace eg
