#pragma once
// Symmetric 6×6 matrices of eight grains at once.
#include <array>
#include <utility>

#include "base/batch.hpp"

namespace eg {

/// The lower triangle of a symmetric 6×6 matrix, for eight grains at once.
struct Triangle {
  std::array<Batch, 21> a;
  static constexpr std::size_t at(std::size_t r, std::size_t c) { return r >= c ? r * (r + 1) / 2 + c : at(c, r); }
  EG_INLINE Batch& operator()(std::size_t r, std::size_t c) { return a[at(r, c)]; }
  EG_INLINE const Batch& operator()(std::size_t r, std::size_t c) const { return a[at(r, c)]; }

  EG_INLINE Batch trace() const { return ((a[0] + a[2]) + (a[5] + a[9])) + (a[14] + a[20]); }
};

EG_INLINE Batch trace_of_product(const Triangle& x, const Triangle& y) {
  Batch diagonal(0.0), rest(0.0);
  for (std::size_t r = 0; r < 6; ++r) {
    diagonal = diagonal + x(r, r) * y(r, r);
    for (std::size_t c = 0; c < r; ++c) rest = rest + x(r, c) * y(r, c);
  }
  return diagonal + rest + rest;
}

/// Divides by the trace, which it returns.
EG_INLINE Batch normalise(Triangle& x) {
  const Batch trace = x.trace(), inverse = select(trace > Batch(0.0), Batch(1.0) / trace, Batch(0.0));
  for (Batch& value : x.a) value = value * inverse;
  return trace;
}

/// Entry (r, c) of x²; unrolled here, since g++ leaves loops over six as loops.
template <std::size_t r, std::size_t c, std::size_t... k>
EG_INLINE Batch square_entry(const Triangle& x, std::index_sequence<k...>) {
  return ((x.a[Triangle::at(r, k)] * x.a[Triangle::at(k, c)]) + ...);
}
template <std::size_t r, std::size_t... c>
EG_INLINE void square_row(const Triangle& x, Triangle& y, std::index_sequence<c...>) {
  ((y.a[Triangle::at(r, c)] = square_entry<r, c>(x, std::make_index_sequence<6>())), ...);
}
template <std::size_t... r>
EG_INLINE Triangle square(const Triangle& x, std::index_sequence<r...>) {
  Triangle y;
  (square_row<r>(x, y, std::make_index_sequence<r + 1>()), ...);
  return y;
}
EG_INLINE Triangle square(const Triangle& x) { return square(x, std::make_index_sequence<6>()); }

}  // namespace eg
