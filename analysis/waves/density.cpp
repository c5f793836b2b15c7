#include "waves/density.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "assembly/apply.hpp"
#include "assembly/stiffness.hpp"
#include "base/error.hpp"
#include "base/random.hpp"
#include "eigen/lanczos.hpp"
#include "eigen/vectors.hpp"

namespace eg {
namespace {

constexpr double pi = std::numbers::pi;

/// Edges of equal intervals that hold the highest mode with room for its round-off.
std::vector<double> edges_up_to(double highest, int bins) {
  std::vector<double> edge;
  for (int k = 0; k <= bins; ++k) edge.push_back(highest * (1 + 1e-6) * k / bins);
  return edge;
}

/// Chebyshev moments Σ_n of one random vector: xᵀ T_n(H) x for n < moments, H = 2A/top − 1. Two a product.
class Moments {
 public:
  Moments(const StiffnessOperator& a, double top) : a_(a), top_(top), next_(a.rows()) {}

  std::vector<double> of(std::vector<double> x, int count) {
    std::vector<double> mu(static_cast<std::size_t>(count));
    std::vector<double> before = x, now(x.size());
    scaled(x, now);
    const double m0 = dot(x, x), m1 = dot(x, now);
    for (int n = 0; 2 * n < count; ++n) {  // T_2n = 2 T_n² − 1, T_2n+1 = 2 T_n T_n+1 − T_1
      mu[static_cast<std::size_t>(2 * n)] = 2 * dot(before, before) - m0;
      if (2 * n + 1 < count) mu[static_cast<std::size_t>(2 * n + 1)] = 2 * dot(before, now) - m1;
      scaled(now, next_);
      eg::scale(next_, 2);
      add_scaled(next_, -1, before);
      std::swap(before, now);
      std::swap(now, next_);
    }
    return mu;
  }

 private:
  void scaled(const std::vector<double>& x, std::vector<double>& y) const {
    a_.apply(x, y);
    eg::scale(y, 2 / top_);
    add_scaled(y, -1, x);
  }
  const StiffnessOperator& a_;
  double top_;
  std::vector<double> next_;
};

/// Jackson's damping of moment n out of `count`: the least smearing that leaves the density positive.
double jackson(int n, int count) {
  const double q = pi / (count + 1);
  return ((count - n + 1) * std::cos(q * n) + std::sin(q * n) / std::tan(q)) / (count + 1);
}

/// Modes below each edge, from moments with sum rule mu[0]: ∫ of the series over the angle, cos θ = 2 λ/top − 1.
std::vector<double> modes_below(const std::vector<double>& mu, const std::vector<double>& edge, double top) {
  std::vector<double> below;
  const int count = static_cast<int>(mu.size());
  for (const double f : edge) {
    const double x = std::clamp(2 * std::pow(2 * pi * f, 2) / top - 1, -1.0, 1.0), angle = std::acos(x);
    double sum = mu[0] * (pi - angle);
    for (int n = 1; n < count; ++n)
      sum -= 2 * jackson(n, count) * mu[static_cast<std::size_t>(n)] * std::sin(n * angle) / n;
    below.push_back(sum / pi);
  }
  return below;
}

}  // namespace

Density dense_density(const ModeSet& all, int bins) {
  Density d;
  d.method = "all modes";
  d.total = static_cast<double>(all.total);
  d.highest = all.modes.empty() ? 0 : all.modes.back().frequency();
  d.edge = edges_up_to(d.highest, bins);
  d.modes.assign(static_cast<std::size_t>(bins), 0.0);
  d.modes[0] = static_cast<double>(all.zero.value_or(0));
  for (const auto& mode : all.modes) {
    const auto bin = std::ranges::upper_bound(d.edge, mode.frequency()) - d.edge.begin() - 1;
    d.modes[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(bin, 0, bins - 1))] += 1;
  }
  return d;
}

Density kernel_density(const Network& network, int bins, const KernelOptions& options) {
  const StiffnessOperator a(network, StiffnessOperator::Scaling::mass);
  const double highest = lanczos_largest(a, {.tolerance = 1e-7}).value;
  if (!(highest > 0)) throw RunError("nothing in this packing can vibrate: no grain that can move touches anything");
  const double top = highest * (1 + 1e-4);  // above λmax, within which the polynomials stay bounded
  const auto inverse = inverse_mass_diagonal(network);
  Density d;
  d.method = "kernel polynomial";
  d.highest = std::sqrt(highest) / (2 * pi);
  d.edge = edges_up_to(d.highest, bins);
  d.total = static_cast<double>(std::ranges::count_if(inverse, [](double x) { return x > 0; }));
  d.moments = options.moments > 0 ? options.moments : 40 * bins;
  d.vectors = options.vectors > 0 ? options.vectors : std::max(8, static_cast<int>(std::ceil(1.5e6 / d.total)));

  Random random(options.seed);
  Moments moments(a, top);
  std::vector<double> sum(d.edge.size(), 0.0), squares(d.edge.size(), 0.0);
  for (int v = 0; v < d.vectors; ++v) {
    std::vector<double> x(a.rows());
    for (std::size_t k = 0; k < x.size(); ++k) x[k] = inverse[k] > 0 ? (random.below(2) == 0 ? -1.0 : 1.0) : 0.0;
    const auto below = modes_below(moments.of(std::move(x), d.moments), d.edge, top);
    for (std::size_t k = 0; k < below.size(); ++k) sum[k] += below[k], squares[k] += below[k] * below[k];
    if (options.progress) options.progress((v + 1.0) / d.vectors);
  }
  const double n = d.vectors;
  for (std::size_t k = 0; k < sum.size(); ++k)
    d.error = std::max(d.error, std::sqrt(std::max(squares[k] / n - sum[k] * sum[k] / (n * n), 0.0) / n) / d.total);
  for (std::size_t k = 0; k + 1 < sum.size(); ++k) {
    const double below = k == 0 ? 0 : sum[k] / n, above = k + 2 == sum.size() ? d.total : sum[k + 1] / n;
    d.modes.push_back(above - below);
  }
  return d;
}

}  // namespace eg
