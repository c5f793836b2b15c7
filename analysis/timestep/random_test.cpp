#include "timestep/random_test.hpp"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "assembly/apply.hpp"
#include "eigen/vectors.hpp"

namespace eg {
namespace {

constexpr int vectors = 2;       // independent: their errors multiply
constexpr double error = 1e-5;   // of one
constexpr double growth = 4;     // asked for beyond what rules the eigenvalue out: vectors of length 1 end near 0.7
constexpr double noise = 1e-11;  // round-off of the recurrence, over T_k: some 30 sums of 100 ε each matter (docs)

}  // namespace

RandomTest random_test(const Network& network, double lower, double sigma, std::uint64_t seed) {
  const StiffnessOperator a(network, StiffnessOperator::Scaling::mass);
  const auto rows = static_cast<double>(a.rows());
  // |b·v| < η for a unit vector v with probability at most η √(2n/π).
  const double component = error / std::sqrt(2 * rows / std::numbers::pi) - noise;
  RandomTest test{false, std::pow(error, vectors), 0};
  if (!(component > 0)) return test;
  const double rate = std::acosh(2 * sigma / lower - 1);  // T_k at sigma is cosh(k rate)
  const int degree = static_cast<int>(std::ceil(std::acosh(growth / component) / rate));
  const double most = component * std::cosh(degree * rate);
  test.below = true;
  for (int v = 0; v < vectors; ++v) {
    // T_{k+1} = 2 (2A/lower − 1) T_k − T_{k−1}
    std::vector<double> before = random_unit_vector(a.rows(), seed + 1000003ull * static_cast<std::uint64_t>(v + 1));
    std::vector<double> now(a.rows()), next(a.rows());
    a.apply(before, now);
    scale(now, 2 / lower);
    add_scaled(now, -1, before);
    for (int k = 1; k < degree; ++k) {
      a.apply(now, next);
      scale(next, 4 / lower);
      add_scaled(next, -2, now);
      add_scaled(next, -1, before);
      std::swap(before, now);
      std::swap(now, next);
    }
    test.products += degree;
    test.below = test.below && norm(now) < most;
  }
  return test;
}

}  // namespace eg
