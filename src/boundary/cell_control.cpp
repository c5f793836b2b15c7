#include "boundary/cell_control.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "measure/volume.hpp"

namespace eg {
namespace {

using Kind = ComponentControl::Kind;
using Quantity = CellCondition::Quantity;

struct Place {
  int row, column;
};
constexpr std::array<Place, 6> places{{{0, 0}, {1, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}}};
constexpr std::array<const char*, 6> names{"x", "y", "z", "yz", "xz", "xy"};
constexpr double answer_steps = 4;  // τ

double sign_of(std::size_t k) { return k < 3 ? -1.0 : 1.0; }  // L is a stretching; x, y, z count compression positive

double largest(const Components& c) {
  double most = 0;
  for (const double x : c) most = std::max(most, std::abs(x));
  return most;
}

/// Σ kn d²/(9V), 2D: 4V [Pa].
double affine_bulk_modulus(const State& state) {
  return state.stiffness_sum / ((state.dimension == 3 ? 9 : 4) * state.cell.volume());
}

/// "stress x" or "0.333 x + 0.333 y + 0.333 z".
std::string name_of(const CellCondition& condition) {
  std::string text;
  std::size_t terms = 0;
  for (std::size_t k = 0; k < 6; ++k) {
    const double c = condition.coefficient[k];
    if (c == 0) continue;
    ++terms;
    text += fmt::format("{}{:.3g} {}",
                        text.empty() ? ""
                        : c < 0      ? " - "
                                     : " + ",
                        text.empty() ? c : std::abs(c), names[k]);
  }
  return "stress " + (terms == 1 && text.starts_with("1 ") ? text.substr(2) : text);
}

/// Calls f(condition) for every stress target of a stage.
template <class F>
void each_target(const StageSpec& stage, F&& f) {
  for (std::size_t k = 0; k < 6; ++k) {
    if (stage.control[k].kind != Kind::stress) continue;
    CellCondition target{Quantity::stress, {}, stage.control[k].value};
    target.coefficient[k] = 1;
    f(target);
  }
  for (const auto& condition : stage.hold)
    if (condition.quantity == Quantity::stress) f(condition);
}

double relative_miss(const State& state, const Components& stress, const CellCondition& target) {
  const double scale = target.value != 0 ? std::abs(target.value) : std::abs(mean_stress(state));
  const double miss = std::abs(weighted(target.coefficient, stress) - target.value);
  return scale > 0 ? miss / scale : miss > 0 ? 1.0 : 0.0;
}

/// Turns the stage's rates around where the quantity has gone past a limit in the direction under way.
void turn_at_limits(State& state, const CycleSpec& cycle) {
  auto& c = state.cycle;
  if ((cycle_value(state, cycle) - cycle.mean) * c.direction < cycle.amplitude) return;
  c.direction = -c.direction;
  ++c.turns;
}

}  // namespace

Components stress_components(const State& state) {
  Components s{};
  for (std::size_t k = 0; k < 6; ++k) {  // grains that turn faster and faster make it unsymmetric
    const auto [row, column] = places[k];
    s[k] = -0.5 * sign_of(k) * (state.virial(row, column) + state.virial(column, row)) / specimen_volume(state);
  }
  return s;
}

double mean_stress(const State& state) {
  const auto s = stress_components(state);
  return state.dimension == 3 ? (s[0] + s[1] + s[2]) / 3 : (s[0] + s[1]) / 2;
}

Components stage_strain(const State& state) {
  Components e{};
  for (std::size_t k = 0; k < 6; ++k) e[k] = sign_of(k) * state.cell.strain(places[k].row, places[k].column);
  return e;
}

double axial_strain(const State& state) { return std::abs(stage_strain(state)[state.dimension == 3 ? 2 : 1]); }

double shear_strain(const State& state) {
  const auto e = stage_strain(state);
  return std::max({std::abs(e[3]), std::abs(e[4]), std::abs(e[5])});
}

double cycle_value(const State& state, const CycleSpec& cycle) {
  return weighted(cycle.coefficient,
                  cycle.quantity == CycleSpec::Quantity::stress ? stress_components(state) : stage_strain(state));
}

TargetMiss worst_target(const State& state, const StageSpec& stage) {
  TargetMiss worst;
  const auto stress = stress_components(state);
  each_target(stage, [&](const CellCondition& target) {
    const double miss = relative_miss(state, stress, target);
    if (!worst.text.empty() && miss <= worst.relative) return;
    worst = {miss, fmt::format("{} = {:.4g}, target {:.4g}", name_of(target), weighted(target.coefficient, stress),
                               target.value)};
  });
  return worst;
}

double stress_error(const State& state, const StageSpec& stage) {
  double worst = 0;
  const auto stress = stress_components(state);
  each_target(stage, [&](const CellCondition& t) { worst = std::max(worst, relative_miss(state, stress, t)); });
  return worst;
}

bool needs_stress(const StageSpec& stage) {
  bool needed = stage.cycle && stage.cycle->quantity == CycleSpec::Quantity::stress;
  each_target(stage, [&](const CellCondition&) { needed = true; });
  for (const auto& c : stage.control) needed = needed || c.kind == Kind::inertial;
  return needed;
}

CellControl::CellControl(const StageSpec& stage, const State& state, double density)
    : stage_(&stage), drive_(stage, state.dimension), inertia_scale_(size_statistics(state).d50 * std::sqrt(density)) {
  if (!drive_.solvable())
    throw InputError(fmt::format("stage \"{}\": its conditions on the cell have no unique solution", stage.name));
}

Components CellControl::known_rates(const State& state) const {
  Components rate{};
  const double turn = stage_->cycle ? state.cycle.direction : 1.0;
  for (std::size_t k = 0; k < 6; ++k) {
    const auto& c = stage_->control[k];
    if (c.kind == Kind::rate) rate[k] = turn * c.value;
    if (c.kind == Kind::inertial && inertia_scale_ > 0)
      rate[k] = turn * c.value * std::sqrt(std::max(0.0, mean_stress(state))) / inertia_scale_;
  }
  return rate;
}

void CellControl::set_rate(State& state, double dt) const {
  if (stage_->cycle) turn_at_limits(state, *stage_->cycle);
  const auto stress = stress_components(state);
  const Components known = known_rates(state);
  const double modulus = affine_bulk_modulus(state);
  const double cap =
      std::isnan(stage_->max_strain_rate) ? std::max(10.0, 10 * largest(known)) : stage_->max_strain_rate;
  Components given{}, error{}, answer{};  // right-hand sides: of rate equations; e/(Mτ); with its integral
  const auto& equations = drive_.equations();
  double worst = 0;
  for (std::size_t e = 0; e < equations.size(); ++e) {
    if (equations[e].quantity == Quantity::rate)
      given[e] = equations[e].value;
    else
      error[e] = equations[e].value - weighted(equations[e].coefficient, stress),
      worst = std::max(worst, std::abs(error[e]));
  }
  // Without contacts the cell just moves the right way, as fast as it may.
  const double scale = modulus > 0 ? 1 / (modulus * answer_steps * dt) : worst > 0 ? 1e3 * cap / worst : 0;
  for (std::size_t e = 0; e < equations.size(); ++e) error[e] *= scale, answer[e] = error[e] + state.servo[e];

  Components rate = drive_.rates(known, given);
  const Components by_servo = drive_.rates({}, answer);
  const double most = largest(by_servo), share = most > cap ? cap / most : 1;
  for (std::size_t k = 0; k < 6; ++k) rate[k] += share * by_servo[k];
  if (share == 1 && modulus > 0)
    for (std::size_t e = 0; e < equations.size(); ++e) state.servo[e] += error[e] / (4 * answer_steps);

  state.cell.rate = Mat3{};
  for (std::size_t k = 0; k < 6; ++k) {
    const auto [r, c] = places[k];
    const bool moves =
        state.cell.periodic[static_cast<std::size_t>(r)] && state.cell.periodic[static_cast<std::size_t>(c)];
    if (moves) state.cell.rate(r, c) = sign_of(k) * rate[k];
  }
}

}  // namespace eg
