#include "stiffness/probe.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "dynamics/engine.hpp"
#include "stiffness/elastic_tensor.hpp"

namespace eg {
namespace {

/// Viscous damping c [1/s] that suits the slowest wave across the cell, from contacts and masses at hand.
double damping_of(const State& state) {
  double mass = 0, edge = 0;
  for (const Quad& v : state.grains.velocity) mass += v.w > 0 ? 1 / v.w : 0;
  for (int k = 0; k < state.dimension; ++k) edge = std::max(edge, state.cell.h(k, k));
  const double volume = state.cell.volume(), modulus = state.stiffness_sum / (9 * volume);
  return 2 * std::numbers::pi / edge * std::sqrt(modulus * volume / mass);
}

/// A copy of the packing, strained at once and left to itself.
class Strained {
 public:
  Strained(const Scene& scene, const State& start, int load, double strain, double dt)
      : state_(start), engine_(scene, state_), dt_(dt) {
    for (Quad& v : state_.grains.velocity) v.set({});
    for (Quad& v : state_.grains.spin) v.set({});
    const auto [i, j] = voigt_component(state_.dimension, load);
    state_.dt = dt;
    state_.cell.rate = {};
    state_.cell.rate(i, j) = strain / dt;
    engine_.step(dt, TallyLevel::stress);
    state_.cell.rate = {};
  }
  void advance(int steps) {
    for (int k = 1; k < steps; ++k) engine_.step(dt_, TallyLevel::none);
    engine_.step(dt_, TallyLevel::stress);
  }
  /// Tension positive [Pa].
  Eigen::VectorXd stress() const {
    const Mat3 s = contact_stress(state_);
    const int d = state_.dimension;
    Eigen::VectorXd v(d == 3 ? 6 : 3);
    for (int a = 0; a < v.size(); ++a) {
      const auto [i, j] = voigt_component(d, a);
      v(a) = -0.5 * (s(i, j) + s(j, i));
    }
    return v;
  }

 private:
  State state_;
  Engine engine_;
  double dt_;
};

class Prober {
 public:
  Prober(const Scene& scene, const State& state, const ProbeOptions& options)
      : scene_(scene), start_(state), options_(options) {
    { const Engine measure(scene_, start_); }  // lists and sums, if the state has none
    scene_.energy = false;
    scene_.damping = {};
    scene_.damping.mass = damping_of(start_);
    window_ = std::max(10, static_cast<int>(2 / (scene_.damping.mass * options.step)));
  }

  ProbedModuli run() {
    const int loads = start_.dimension == 3 ? 6 : 3;
    result_.voigt.resize(loads, loads);
    for (int a = 0; a < loads; ++a) {
      load_ = a;
      find_linear();
      if (options_.progress) options_.progress((a + 1.0) / loads);
    }
    return result_;
  }

 private:
  /// Two strains a decade apart whose moduli agree, then upwards to the end of linear behaviour.
  void find_linear() {
    double strain = options_.strain;
    Eigen::VectorXd large = column(strain), small = column(strain / 10), upper = large;
    double linear = strain;
    while (difference(large, small) > options_.agreement && strain > 2e-9) {
      strain /= 10, linear = strain;
      large = small, small = column(strain / 10);
    }
    if (difference(large, small) > options_.agreement) result_.found = false;
    if (linear == options_.strain)
      for (double next = 10 * linear; next < 0.02; next *= 10) {
        if (difference(column(next), small) > options_.end_of_linear) break;
        linear = next;
      }
    else if (difference(upper, small) <= options_.end_of_linear)
      linear = options_.strain;
    result_.voigt.col(load_) = small;
    result_.strain.push_back(strain / 10);
    result_.linear.push_back(linear);
  }

  static double difference(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
    return (a - b).lpNorm<Eigen::Infinity>() / b.lpNorm<Eigen::Infinity>();
  }

  /// Moduli of one load at one strain: the difference of two relaxations, once it rests.
  Eigen::VectorXd column(double strain) {
    Strained plus(scene_, start_, load_, strain, options_.step), minus(scene_, start_, load_, -strain, options_.step);
    const auto moduli = [&] { return ((plus.stress() - minus.stress()) / (2 * strain)).eval(); };
    Eigen::VectorXd last = moduli();
    constexpr int windows = 400, quiet_windows = 4;
    for (int w = 0, quiet = 0; w < windows; ++w) {
      plus.advance(window_), minus.advance(window_);
      result_.steps += 2 * window_;
      const Eigen::VectorXd now = moduli();
      quiet = difference(now, last) < 0.02 * options_.agreement ? quiet + 1 : 0;
      last = now;
      if (quiet == quiet_windows) return last;
    }
    if (strain <= options_.strain) result_.found = false;  // larger ones may flow
    return last;
  }

  Scene scene_;
  State start_;
  ProbeOptions options_;
  int window_ = 0, load_ = 0;
  ProbedModuli result_;
};

}  // namespace

ProbedModuli probe(const Scene& scene, const State& state, const ProbeOptions& options) {
  if (!(options.step > 0)) throw std::invalid_argument("probe: step must be positive");
  return Prober(scene, state, options).run();
}

}  // namespace eg
