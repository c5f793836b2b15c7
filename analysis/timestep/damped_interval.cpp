#include "timestep/damped_interval.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "assembly/apply.hpp"
#include "eigen/vectors.hpp"

namespace eg {
namespace {

constexpr double rounding = 1e-14;        // of the few operations on a proved number
constexpr double quotient_error = 2e-12;  // of a Rayleigh quotient, as in interval.cpp

/// The root of λ Δt² + 2c Δt = 4; infinite when neither limits.
double neutral_step(double lambda, double c) { return 4 / (c + std::sqrt(c * c + 4 * lambda)); }

/// What λ ≥ λmax of the network damped at `step` proves: K + 2C/Δt is at most step/Δt times as large for Δt < step, and
/// not larger for Δt ≥ step.
double proved_step(double lambda, double step, double c) {
  const double shorter = 4 / (step * lambda + 2 * c);
  return (shorter <= step ? shorter : neutral_step(lambda, c)) * (1 - rounding);
}

double quotient(const Network& network, const std::vector<double>& x) {
  const StiffnessOperator a(network, StiffnessOperator::Scaling::mass);
  std::vector<double> y(a.rows());
  a.apply(x, y);
  return dot(x, y);
}

/// The step that a mode allows; it is stable for no larger one.
double step_of_mode(const Network& network, const Network& viscous, const DampingSpec& damping,
                    const std::vector<double>& mode) {
  const double a = (1 + damping.local) * quotient(network, mode) * (1 - quotient_error);
  const double b = (1 + damping.local) * quotient(viscous, mode) * (1 - quotient_error) + damping.mass;
  return neutral_step(a, b) * (1 + rounding);
}

}  // namespace

DampedInterval damped_interval(const Network& network, const DampingSpec& damping, const StepInterval& undamped,
                               const IntervalOptions& options) {
  const double force = 1 + damping.local;
  DampedInterval v;
  v.method_lower = undamped.method_lower, v.method_upper = undamped.method_upper;
  v.dt_safe = neutral_step(force * undamped.lambda_upper, damping.mass) * (1 - rounding);
  v.dt_limit_upper = neutral_step(force * undamped.lambda_lower, damping.mass) * (1 + rounding);
  if (!damping.dashpots() || undamped.mode.empty()) return v;

  const Network viscous = dashpots(network, damping);
  v.dt_safe = 0;
  double step = v.dt_limit_upper = step_of_mode(network, viscous, damping, undamped.mode);
  for (bool settled = false; !settled && v.rounds < 8; ++v.rounds) {
    const StepInterval now = step_interval(damped_network(network, damping, step), options);
    if (const double safe = proved_step(now.lambda_upper, step, damping.mass); safe > v.dt_safe)
      v.dt_safe = safe, v.method_upper = now.method_upper;
    const double next = step_of_mode(network, viscous, damping, now.mode);
    settled = next > step * (1 - 0.1 * options.width);
    if (next < v.dt_limit_upper) v.dt_limit_upper = next, v.method_lower = now.method_lower;
    step = std::min(step, next);
  }
  return v;
}

double proved_damped_step(double lambda, const DampingSpec& damping, double step) {
  if (!damping.dashpots()) return neutral_step(lambda, damping.mass) * (1 - rounding);
  return proved_step(lambda, step, damping.mass);
}

double refuted_damped_step(double lambda, const DampingSpec& damping, double step) {
  const double longer = 4 / (step * lambda + 2 * damping.mass);  // K + 2C/Δt shrinks by step/Δt at most
  const bool use = damping.dashpots() && longer >= step;
  return (use ? longer : neutral_step(lambda, damping.mass)) * (1 + rounding);
}

double damped_safe_step(const Network& network, const DampingSpec& damping, double guess,
                        const std::function<double(const Network&)>& bound) {
  const auto plain = [&] { return neutral_step((1 + damping.local) * bound(network), damping.mass) * (1 - rounding); };
  if (!damping.dashpots()) return plain();
  double step = guess > 0 && std::isfinite(guess) ? guess : plain(), best = 0;
  for (int round = 0; round < 4 && std::isfinite(step); ++round) {
    const double next = proved_step(bound(damped_network(network, damping, step)), step, damping.mass);
    best = std::max(best, next);
    if (std::abs(next - step) < 5e-3 * step) break;
    step = next;
  }
  return std::isfinite(step) ? best : step;
}

}  // namespace eg
