#include "boundary/cell_control.hpp"

#include <algorithm>
#include <cmath>

namespace eg {
namespace {

struct Place {
  int row, column;
};
constexpr std::array<Place, 6> places{{{0, 0}, {1, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}}};

double sign_of(std::size_t k) { return k < 3 ? -1.0 : 1.0; }  // L is a stretching; x, y, z count compression positive

struct Servo {
  double stiffness, time;
};

Servo servo_of(const State& state, double dt) {
  const double volume = state.cell.volume();
  double mass = 0;
  for (const auto& v : state.grains.velocity) mass += v.w > 0 ? 1 / v.w : 0;
  const double m = state.stiffness_sum / ((state.dimension == 3 ? 9 : 4) * volume);
  const double width =
      std::min({state.cell.h(0, 0), state.cell.h(1, 1), state.dimension == 3 ? state.cell.h(2, 2) : INFINITY});
  return {m, m > 0 ? std::max(width * std::sqrt(mass / volume / m), 20 * dt) : 1.0};
}

/// Rate that answers a stress error; `integral` is carried from step to step.
double answer(double error, const Servo& servo, double& integral, double cap, double dt) {
  if (!(servo.stiffness > 0)) return error > 0 ? cap : error < 0 ? -cap : 0.0;
  const double direct = error / (servo.stiffness * servo.time);
  const double wanted = direct + integral;
  if (std::abs(wanted) <= cap) integral += direct * dt / (4 * servo.time);
  return std::clamp(wanted, -cap, cap);
}

}  // namespace

std::array<double, 6> stress_components(const State& state) {
  std::array<double, 6> s{};
  for (std::size_t k = 0; k < 6; ++k)
    s[k] = -sign_of(k) * state.virial(places[k].row, places[k].column) / state.cell.volume();
  return s;
}

double mean_stress(const State& state) {
  const auto s = stress_components(state);
  return state.dimension == 3 ? (s[0] + s[1] + s[2]) / 3 : (s[0] + s[1]) / 2;
}

std::array<double, 6> stage_strain(const State& state) {
  std::array<double, 6> e{};
  for (std::size_t k = 0; k < 6; ++k) {
    const auto [r, c] = places[k];
    e[k] = k < 3 ? -std::log(state.cell.h(r, r) / state.stage_cell(r, r))
                 : (state.cell.h(r, c) - state.stage_cell(r, c)) / state.cell.h(c, c);
  }
  return e;
}

void control_cell(State& state, const StageSpec& stage, double dt) {
  const auto stress = stress_components(state);
  const Servo servo = servo_of(state, dt);
  std::array<double, 6> rate{};
  for (std::size_t k = 0; k < 6; ++k) {
    const auto& c = stage.control[k];
    if (k < 3 && stage.mean_axes[k]) continue;  // below; they have one integral together
    rate[k] = c.kind == ComponentControl::Kind::rate
                  ? c.value
                  : answer(c.value - stress[k], servo, state.servo[k], stage.max_strain_rate, dt);
  }
  if (stage.mean_stress) {
    double& integral = state.servo[stage.mean_axes[0] ? 0 : stage.mean_axes[1] ? 1 : 2];
    const double common = answer(*stage.mean_stress - mean_stress(state), servo, integral, stage.max_strain_rate, dt);
    for (std::size_t k = 0; k < 3; ++k)
      if (stage.mean_axes[k]) rate[k] = common;
  }
  state.cell.rate = Mat3{};
  for (std::size_t k = 0; k < 6; ++k) {
    const auto [r, c] = places[k];
    const bool moves =
        state.cell.periodic[static_cast<std::size_t>(r)] && state.cell.periodic[static_cast<std::size_t>(c)];
    if (moves) state.cell.rate(r, c) = sign_of(k) * rate[k];
  }
}

double stress_error(const State& state, const StageSpec& stage) {
  const auto stress = stress_components(state);
  double worst = 0;
  const auto count = [&](double value, double target) {
    const double scale = target != 0 ? std::abs(target) : std::abs(mean_stress(state));
    worst = std::max(worst, scale > 0 ? std::abs(value - target) / scale : std::abs(value - target) > 0 ? 1.0 : 0.0);
  };
  for (std::size_t k = 0; k < 6; ++k)
    if (stage.control[k].kind == ComponentControl::Kind::stress) count(stress[k], stage.control[k].value);
  if (stage.mean_stress) count(mean_stress(state), *stage.mean_stress);
  return worst;
}

}  // namespace eg
