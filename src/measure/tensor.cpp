#include "measure/tensor.hpp"

#include <cmath>
#include <utility>

namespace eg {

namespace {

Mat3 symmetric_part(const Mat3& m) { return 0.5 * (m + transpose(m)); }

/// Turns axes p and q of the symmetric m so that m(p, q) vanishes; the columns of `axes` follow.
void rotate_away(Mat3& m, Mat3& axes, int p, int q) {
  if (m(p, q) == 0) return;
  const double theta = (m(q, q) - m(p, p)) / (2 * m(p, q));
  const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::hypot(theta, 1.0));
  const double c = 1 / std::hypot(t, 1.0), s = t * c;
  Mat3 turn = Mat3::identity();
  turn(p, p) = turn(q, q) = c;
  turn(p, q) = s, turn(q, p) = -s;
  m = transpose(turn) * m * turn;
  axes = axes * turn;
  m(p, q) = m(q, p) = 0;
}

}  // namespace

double mean_value(const Mat3& m, int dimension) {
  return (m(0, 0) + m(1, 1) + (dimension == 3 ? m(2, 2) : 0)) / dimension;
}

double deviator_product(const Mat3& a, const Mat3& b, int dimension) {
  const Mat3 sa = symmetric_part(a), sb = symmetric_part(b);
  const double pa = mean_value(sa, dimension), pb = mean_value(sb, dimension);
  double sum = 0;
  for (int i = 0; i < dimension; ++i)
    for (int j = 0; j < dimension; ++j) sum += (sa(i, j) - (i == j ? pa : 0)) * (sb(i, j) - (i == j ? pb : 0));
  return sum;
}

double deviator_share(const Mat3& part, const Mat3& whole, int dimension) {
  const double square = deviator_product(whole, whole, dimension);
  return square > 0 ? deviator_product(part, whole, dimension) / square : 0;
}

double deviator(const Mat3& tensor, int dimension) {
  return std::sqrt((dimension == 3 ? 1.5 : 2.0) * deviator_product(tensor, tensor, dimension));
}

Principal principal(const Mat3& tensor, int dimension) {
  Mat3 m = symmetric_part(tensor), axes = Mat3::identity();
  rotate_away(m, axes, 0, 1);
  for (int sweep = 0; dimension == 3 && sweep < 10; ++sweep) {  // converges quadratically: 4 or 5 are enough
    rotate_away(m, axes, 0, 1);
    rotate_away(m, axes, 0, 2);
    rotate_away(m, axes, 1, 2);
  }
  std::array order{0, 1, 2};
  const auto sort_pair = [&](int& a, int& b) {
    if (m(a, a) < m(b, b)) std::swap(a, b);
  };
  sort_pair(order[0], order[1]);
  if (dimension == 3) sort_pair(order[1], order[2]), sort_pair(order[0], order[1]);
  Principal result;
  for (std::size_t k = 0; k < 3; ++k) {
    const int column = order[k];
    result.values[k] = k < static_cast<std::size_t>(dimension) ? m(column, column) : 0;
    result.axes[k] = {axes(0, column), axes(1, column), axes(2, column)};
  }
  return result;
}

}  // namespace eg
