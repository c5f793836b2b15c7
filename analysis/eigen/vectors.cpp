#include "eigen/vectors.hpp"

#include <algorithm>
#include <cmath>

#include "base/random.hpp"

namespace eg {
namespace {

constexpr std::ptrdiff_t piece = 4096;

double piece_dot(const double* x, const double* y, std::ptrdiff_t size) {
  double lane[8] = {};
  std::ptrdiff_t k = 0;
  for (; k + 8 <= size; k += 8)
    for (int l = 0; l < 8; ++l) lane[l] += x[k + l] * y[k + l];
  for (int l = 0; k < size; ++k, ++l) lane[l] += x[k] * y[k];
  return ((lane[0] + lane[1]) + (lane[2] + lane[3])) + ((lane[4] + lane[5]) + (lane[6] + lane[7]));
}

}  // namespace

double dot(std::span<const double> x, std::span<const double> y) {
  const auto size = static_cast<std::ptrdiff_t>(x.size()), pieces = (size + piece - 1) / piece;
  std::vector<double> part(static_cast<std::size_t>(pieces));
#pragma omp parallel for schedule(static) if (pieces > 8)
  for (std::ptrdiff_t p = 0; p < pieces; ++p)
    part[static_cast<std::size_t>(p)] =
        piece_dot(x.data() + p * piece, y.data() + p * piece, std::min(piece, size - p * piece));
  double sum = 0;
  for (const double value : part) sum += value;
  return sum;
}

double norm(std::span<const double> x) { return std::sqrt(dot(x, x)); }

void add_scaled(std::span<double> y, double a, std::span<const double> x) {
  const auto size = static_cast<std::ptrdiff_t>(x.size());
#pragma omp parallel for simd schedule(static) if (size > 8 * piece)
  for (std::ptrdiff_t k = 0; k < size; ++k) y[k] += a * x[k];
}

void scale_and_add(std::span<double> y, double a, std::span<const double> x) {
  const auto size = static_cast<std::ptrdiff_t>(x.size());
#pragma omp parallel for simd schedule(static) if (size > 8 * piece)
  for (std::ptrdiff_t k = 0; k < size; ++k) y[k] = a * y[k] + x[k];
}

void scale(std::span<double> x, double a) {
  for (double& value : x) value *= a;
}

std::vector<double> random_unit_vector(std::size_t size, std::uint64_t seed) {
  Random random(seed);
  std::vector<double> x(size);
  for (double& value : x) value = random.normal();
  if (const double length = norm(x); length > 0) scale(x, 1 / length);
  return x;
}

}  // namespace eg
