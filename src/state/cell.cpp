#include "state/cell.hpp"

#include <cmath>

namespace eg {
namespace {

/// exp(A) − 1 of a small upper-triangular A; |A|⁷/5040 is left out.
Mat3 exponential_minus_one(const Mat3& a) {
  Mat3 sum = a;
  sum *= 1. / 6;
  for (const double k : {5., 4., 3., 2., 1.}) {
    sum = a * (Mat3::identity() + sum);
    sum *= 1 / k;
  }
  return sum;
}

void add_compensated(Mat3& sum, Mat3& low, const Mat3& change) {  // Kahan 1965
  for (std::size_t k = 0; k < 9; ++k) {
    const double add = change.a[k] - low.a[k];
    const double next = sum.a[k] + add;
    low.a[k] = (next - sum.a[k]) - add;
    sum.a[k] = next;
  }
}

}  // namespace

double Cell::width(int k) const {
  const Mat3 inv = inverse(h);  // rows are the reciprocal vectors: planes of direction k lie 1/|row k| apart
  return 1.0 / norm(Vec3{inv(k, 0), inv(k, 1), inv(k, 2)});
}

Mat3 Cell::deform(double dt) {
  Mat3 stretch = rate;
  stretch *= dt;
  add_compensated(strain, strain_low, stretch);
  const Mat3 change = exponential_minus_one(stretch);
  add_compensated(h, h_low, change * h);
  return change;
}

std::array<int, 3> Cell::straighten() {
  const auto take = [this](int from, int edge, double n) {
    for (int r = 0; r <= edge; ++r) h(r, from) -= n * h(r, edge), h_low(r, from) -= n * h_low(r, edge);
  };
  std::array<int, 3> n{};
  const std::array<std::array<int, 2>, 3> pairs{{{2, 1}, {2, 0}, {1, 0}}};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto [from, edge] = pairs[k];
    const double steps = std::round(h(edge, from) / h(edge, edge));
    n[k] = static_cast<int>(steps);
    if (steps != 0) take(from, edge, steps);
  }
  return n;
}

}  // namespace eg
