#include "timestep/verify.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "assembly/apply.hpp"
#include "eigen/vectors.hpp"

namespace eg {
namespace {

class Stepper {
 public:
  Stepper(const Network& network, const BracketOptions& options)
      : a_(network, StiffnessOperator::Scaling::mass),
        start_(random_unit_vector(a_.rows(), options.seed)),
        force_(a_.rows()) {
    // What cannot move must not be part of the amplitude's start: one product of A clears it.
    a_.apply(start_, force_);
    const double length = norm(force_);
    if (!(length > 0)) throw std::invalid_argument("verify_by_stepping: nothing in this network can vibrate");
    start_ = force_;
    scale(start_, 1 / length);
    const double excess = 0.25 * options.tolerance;  // over the limit, at which growth must show
    const double growth = std::sqrt(8 * excess);     // z = −e^growth a step for ωΔt = 2(1 + excess)
    longest_ = static_cast<int>(std::log(2e3 / least_share) / growth) + 20;
  }

  /// True when the amplitude after k + 1 steps is more than a stable step allows: with x₋₁ = x₀ a mode moves as
  /// x_k = cos((k + ½)φ)/cos(½φ), which is at most 2k + 1.
  bool grows(double dt, std::int64_t& steps) {
    std::vector<double> x = start_, v(x.size(), 0.0);
    for (int k = 0; k < longest_; ++k) {
      a_.apply(x, force_);
      advance(dt, x, v);
      ++steps;
      if (k % 8 == 7 && !(norm(x) < 1.001 * (2 * k + 3))) return true;  // also when it is no longer a number
    }
    return false;
  }

 private:
  void advance(double dt, std::vector<double>& x, std::vector<double>& v) const {
    const auto size = static_cast<std::ptrdiff_t>(x.size());
    const double* force = force_.data();
    double *position = x.data(), *velocity = v.data();
#pragma omp parallel for simd schedule(static) if (size > 30000)
    for (std::ptrdiff_t k = 0; k < size; ++k) {
      velocity[k] -= dt * force[k];
      position[k] += dt * velocity[k];
    }
  }

  static constexpr double least_share = 1e-5;  // of the perturbation in the mode that grows first
  StiffnessOperator a_;
  std::vector<double> start_, force_;
  int longest_ = 0;
};

}  // namespace

StabilityBracket verify_by_stepping(const Network& network, const BracketOptions& options) {
  Stepper stepper(network, options);
  return bracket_limit(options, [&](double dt, std::int64_t& steps) { return stepper.grows(dt, steps); });
}

}  // namespace eg
