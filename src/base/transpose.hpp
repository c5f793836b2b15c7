#pragma once
// Eight rows of two vectors, a cache line each, to columns and back: fewer shuffles than for rows of eight numbers.
#include "base/batch.hpp"

namespace eg {

/// Eight rows x y z · | x' y' z' · as columns; the fourth and last number of a row are not looked at.
EG_INLINE void transpose_rows(const Double8 (&r)[8], Vec<Batch>& first, Vec<Batch>& second) {
  Double8 even[4], odd[2];  // even: x x z z x' x' z' z' of two rows; odd: y y y' y' of two rows, and of the next two
  for (int k = 0; k < 4; ++k) even[k] = __builtin_shufflevector(r[2 * k], r[2 * k + 1], 0, 8, 2, 10, 4, 12, 6, 14);
  for (int k = 0; k < 2; ++k) {
    const Double8 a = __builtin_shufflevector(r[4 * k], r[4 * k + 1], 1, 9, 1, 9, 5, 13, 5, 13);
    const Double8 b = __builtin_shufflevector(r[4 * k + 2], r[4 * k + 3], 1, 9, 1, 9, 5, 13, 5, 13);
    odd[k] = __builtin_shufflevector(a, b, 0, 1, 8, 9, 4, 5, 12, 13);
  }
  const Double8 x0 = __builtin_shufflevector(even[0], even[1], 0, 1, 8, 9, 4, 5, 12, 13);  // x of rows 0–3 | x' of them
  const Double8 x4 = __builtin_shufflevector(even[2], even[3], 0, 1, 8, 9, 4, 5, 12, 13);
  const Double8 z0 = __builtin_shufflevector(even[0], even[1], 2, 3, 10, 11, 6, 7, 14, 15);
  const Double8 z4 = __builtin_shufflevector(even[2], even[3], 2, 3, 10, 11, 6, 7, 14, 15);
  const auto lower = [](Double8 a, Double8 b) { return __builtin_shufflevector(a, b, 0, 1, 2, 3, 8, 9, 10, 11); };
  const auto upper = [](Double8 a, Double8 b) { return __builtin_shufflevector(a, b, 4, 5, 6, 7, 12, 13, 14, 15); };
  first.x = lower(x0, x4), first.y = lower(odd[0], odd[1]), first.z = lower(z0, z4);
  second.x = upper(x0, x4), second.y = upper(odd[0], odd[1]), second.z = upper(z0, z4);
}

/// The inverse; the fourth and last number of a row are anything.
EG_INLINE void transpose_columns(const Vec<Batch>& p, const Vec<Batch>& q, Double8 (&r)[8]) {
  const auto lower = [](Batch a, Batch b) { return __builtin_shufflevector(a.v, b.v, 0, 1, 2, 3, 8, 9, 10, 11); };
  const auto upper = [](Batch a, Batch b) { return __builtin_shufflevector(a.v, b.v, 4, 5, 6, 7, 12, 13, 14, 15); };
  const Double8 x[2] = {lower(p.x, q.x), upper(p.x, q.x)};  // of rows 0–3 | x' of them; of rows 4–7
  const Double8 y[2] = {lower(p.y, q.y), upper(p.y, q.y)}, z[2] = {lower(p.z, q.z), upper(p.z, q.z)};
  for (std::size_t k = 0; k < 2; ++k) {
    const Double8 xz0 = __builtin_shufflevector(x[k], z[k], 0, 1, 8, 9, 4, 5, 12, 13);  // x x z z of rows 0, 1 | …
    const Double8 xz2 = __builtin_shufflevector(x[k], z[k], 2, 3, 10, 11, 6, 7, 14, 15);
    const Double8 y2 = __builtin_shufflevector(y[k], y[k], 2, 3, 2, 3, 6, 7, 6, 7);
    r[4 * k] = __builtin_shufflevector(xz0, y[k], 0, 8, 2, 10, 4, 12, 6, 14);
    r[4 * k + 1] = __builtin_shufflevector(xz0, y[k], 1, 9, 3, 11, 5, 13, 7, 15);
    r[4 * k + 2] = __builtin_shufflevector(xz2, y2, 0, 8, 2, 10, 4, 12, 6, 14);
    r[4 * k + 3] = __builtin_shufflevector(xz2, y2, 1, 9, 3, 11, 5, 13, 7, 15);
  }
}

}  // namespace eg
