#include "state/cell.hpp"

namespace eg {

double Cell::width(int k) const {
  const Mat3 inv = inverse(h);  // rows are the reciprocal vectors: planes of direction k lie 1/|row k| apart
  return 1.0 / norm(Vec3{inv(k, 0), inv(k, 1), inv(k, 2)});
}

void Cell::deform(double dt) {
  Mat3 change = rate * h;
  change *= dt;
  for (std::size_t k = 0; k < 9; ++k) {  // Kahan 1965
    const double add = change.a[k] - h_low.a[k];
    const double sum = h.a[k] + add;
    h_low.a[k] = (sum - h.a[k]) - add;
    h.a[k] = sum;
  }
}

}  // namespace eg
