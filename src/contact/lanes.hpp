#pragma once
// Loads and stores of grain rows for one contact (S = double) or eight (S = Batch), so that one loop serves both.
#include <bit>

#include "base/number.hpp"

namespace eg {

template <class S>
struct Columns {
  S x, y, z, w;
};

EG_INLINE Double4 quad_vector(const Quad& q) { return *reinterpret_cast<const Double4*>(&q); }

/// Rows index[0…lanes) of an array of quads, plus rows of a second table when given (image translations).
template <class S>
EG_INLINE Columns<S> load_quads(const Quad* rows, const Index* index, const Quad* add = nullptr,
                                const std::uint8_t* add_index = nullptr) {
  if constexpr (lanes_of<S> == 1) {
    const Quad& q = rows[index[0]];
    if (!add) return {q.x, q.y, q.z, q.w};
    const Quad& a = add[add_index[0]];
    return {q.x + a.x, q.y + a.y, q.z + a.z, q.w};
  } else {
    const auto row = [&](std::size_t k) {
      const Double4 q = quad_vector(rows[index[k]]);
      return add ? q + quad_vector(add[add_index[k]]) : q;
    };
    const auto c = transpose_rows(row(0), row(1), row(2), row(3), row(4), row(5), row(6), row(7));
    return {c.x, c.y, c.z, c.w};
  }
}

/// rows[index[k]·stride + offset] += column values of lane k, lane after lane.
template <class S>
EG_INLINE void add_quads(Quad* rows, const Index* index, std::size_t stride, std::size_t offset, const Columns<S>& v) {
  if constexpr (lanes_of<S> == 1) {
    Quad& q = rows[index[0] * stride + offset];
    q.x += v.x, q.y += v.y, q.z += v.z, q.w += v.w;
  } else {
    Double4 r[8];
    transpose_columns({v.x, v.y, v.z, v.w}, r);
    for (std::size_t k = 0; k < 8; ++k) {
      auto& q = *reinterpret_cast<Double4*>(rows + index[k] * stride + offset);
      q += r[k];
    }
  }
}

template <class S>
EG_INLINE Vec<S> xyz(const Columns<S>& c) {
  return {c.x, c.y, c.z};
}

template <class S>
EG_INLINE S load_values(const double* p) {
  if constexpr (lanes_of<S> == 1)
    return *p;
  else
    return load_lanes(p);
}
template <class S>
EG_INLINE void store_values(double* p, const S& v) {
  if constexpr (lanes_of<S> == 1)
    *p = v;
  else
    store_lanes(p, v);
}

/// A struct of doubles (a law's Constants) as the same struct of S: all lanes alike, or lane k taken from
/// table[pick(k)].
template <class To, class From, class S, class Pick>
EG_INLINE To gather_struct(const From* table, bool uniform, Pick&& pick) {
  constexpr std::size_t n = sizeof(From) / sizeof(double);
  static_assert(sizeof(To) == n * sizeof(S));
  std::array<S, n> out;
  if (uniform) {
    const auto first = std::bit_cast<std::array<double, n>>(*table);
    for (std::size_t m = 0; m < n; ++m) out[m] = S(first[m]);
  } else if constexpr (lanes_of<S> == 1) {
    const auto one = std::bit_cast<std::array<double, n>>(table[pick(0)]);
    for (std::size_t m = 0; m < n; ++m) out[m] = one[m];
  } else {
    for (std::size_t k = 0; k < lanes_of<S>; ++k) {
      const auto one = std::bit_cast<std::array<double, n>>(table[pick(k)]);
      for (std::size_t m = 0; m < n; ++m) out[m].v[k] = one[m];
    }
  }
  return std::bit_cast<To>(out);
}

}  // namespace eg
