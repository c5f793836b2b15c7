#include "measure/tensor.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace eg {

namespace {

Mat3 symmetric_part(const Mat3& m) { return 0.5 * (m + transpose(m)); }

/// Turns axes p and q of the symmetric m so that m(p, q) vanishes.
void rotate_away(Mat3& m, int p, int q) {
  if (m(p, q) == 0) return;
  const double theta = (m(q, q) - m(p, p)) / (2 * m(p, q));
  const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::hypot(theta, 1.0));
  const double c = 1 / std::hypot(t, 1.0), s = t * c;
  Mat3 turn = Mat3::identity();
  turn(p, p) = turn(q, q) = c;
  turn(p, q) = s, turn(q, p) = -s;
  m = transpose(turn) * m * turn;
  m(p, q) = m(q, p) = 0;
}

}  // namespace

double mean_value(const Mat3& m, int dimension) {
  return (m(0, 0) + m(1, 1) + (dimension == 3 ? m(2, 2) : 0)) / dimension;
}

double deviator(const Mat3& tensor, int dimension) {
  const Mat3 m = symmetric_part(tensor);
  const double mean = mean_value(m, dimension);
  double square = 0;
  for (int i = 0; i < dimension; ++i)
    for (int j = 0; j < dimension; ++j) {
      const double s = m(i, j) - (i == j ? mean : 0);
      square += s * s;
    }
  return std::sqrt((dimension == 3 ? 1.5 : 2.0) * square);
}

std::array<double, 3> principal_values(const Mat3& tensor, int dimension) {
  Mat3 m = symmetric_part(tensor);
  if (dimension == 2) {
    rotate_away(m, 0, 1);
    return {std::max(m(0, 0), m(1, 1)), std::min(m(0, 0), m(1, 1)), 0};
  }
  for (int sweep = 0; sweep < 10; ++sweep) {  // converges quadratically: 4 or 5 are enough
    rotate_away(m, 0, 1);
    rotate_away(m, 0, 2);
    rotate_away(m, 1, 2);
  }
  std::array values{m(0, 0), m(1, 1), m(2, 2)};
  std::sort(values.begin(), values.end(), std::greater<>());
  return values;
}

}  // namespace eg
