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

/// Combines rows of both sides of a contact before they are transposed, which is what costs.
/// Differences (j + shift[image] − i) of x, y, z and the sum of w.
template <class S>
EG_INLINE Columns<S> load_difference(const Quad* rows, const Index* i, const Index* j, const Quad* shift = nullptr,
                                     const std::uint8_t* image = nullptr) {
  if constexpr (lanes_of<S> == 1) {
    const Quad &a = rows[i[0]], &b = rows[j[0]];
    const Vec3 d = (shift ? b.vec() + shift[image[0]].vec() : b.vec()) - a.vec();
    return {d.x, d.y, d.z, b.w + a.w};
  } else {
    const Double4 sign{-1, -1, -1, 1};
    const auto row = [&](std::size_t k) {
      const Double4 a = quad_vector(rows[i[k]]), b = quad_vector(rows[j[k]]);
      return (shift ? b + quad_vector(shift[image[k]]) : b) + sign * a;
    };
    const auto c = transpose_rows(row(0), row(1), row(2), row(3), row(4), row(5), row(6), row(7));
    return {c.x, c.y, c.z, c.w};
  }
}

/// Rows index[0…lanes) as they are.
template <class S>
EG_INLINE Columns<S> load_rows(const Quad* rows, const Index* index) {
  if constexpr (lanes_of<S> == 1) {
    const Quad& q = rows[index[0]];
    return {q.x, q.y, q.z, q.w};
  } else {
    const auto row = [&](std::size_t k) { return quad_vector(rows[index[k]]); };
    const auto c = transpose_rows(row(0), row(1), row(2), row(3), row(4), row(5), row(6), row(7));
    return {c.x, c.y, c.z, c.w};
  }
}

/// w of rows index[0…lanes).
template <class S>
EG_INLINE S load_w(const Quad* rows, const Index* index) {
  if constexpr (lanes_of<S> == 1) {
    return rows[index[0]].w;
  } else {
    const auto w = [&](std::size_t k) { return rows[index[k]].w; };
    return Double8{w(0), w(1), w(2), w(3), w(4), w(5), w(6), w(7)};
  }
}

/// Adds a contact to the accumulators of both sides: −f to i and f to j, with the moment times each arm behind it when
/// `stride` is 2. Lane after lane, so that one grain may stand in several.
template <std::size_t stride, class S>
EG_INLINE void add_contact(Quad* rows, const Index* i, const Index* j, const Vec<S>& f, const Vec<S>& moment,
                           const S& arm_i, const S& arm_j) {
  if constexpr (lanes_of<S> == 1) {
    const auto add = [](Quad& q, const Vec3& v) { q.set(q.vec() + v); };
    add(rows[stride * i[0]], -f), add(rows[stride * j[0]], f);
    if constexpr (stride == 2) add(rows[2 * i[0] + 1], moment * arm_i), add(rows[2 * j[0] + 1], moment * arm_j);
  } else if constexpr (stride == 2) {
    const auto at = [rows](std::size_t k) -> Double8& { return *reinterpret_cast<Double8*>(rows + 2 * k); };
    Double8 row[8];
    transpose_columns({f.x, f.y, f.z, Batch(0.0)}, {moment.x, moment.y, moment.z, Batch(0.0)}, row);
    for (std::size_t k = 0; k < 8; ++k) {
      const double ai = arm_i[k], aj = arm_j[k];
      at(i[k]) += row[k] * Double8{-1, -1, -1, -1, ai, ai, ai, ai};
      at(j[k]) += row[k] * Double8{1, 1, 1, 1, aj, aj, aj, aj};
    }
  } else {
    const auto at = [rows](std::size_t k) -> Double4& { return *reinterpret_cast<Double4*>(rows + k); };
    Double4 force[8];
    transpose_columns({f.x, f.y, f.z, Batch(0.0)}, force);
    for (std::size_t k = 0; k < 8; ++k) at(i[k]) -= force[k], at(j[k]) += force[k];
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

/// A struct of doubles (a law's Constants) as the same struct of S: all lanes alike …
template <class To, class S, class From>
EG_INLINE To broadcast_struct(const From& one) {
  constexpr std::size_t n = sizeof(From) / sizeof(double);
  static_assert(sizeof(To) == n * sizeof(S));
  const auto values = std::bit_cast<std::array<double, n>>(one);
  std::array<S, n> out;
  for (std::size_t m = 0; m < n; ++m) out[m] = S(values[m]);
  return std::bit_cast<To>(out);
}

/// … or lane k from table[pick(k)].
template <class To, class S, class From, class Pick>
EG_INLINE To gather_struct(const From* table, Pick&& pick) {
  if constexpr (lanes_of<S> == 1) {
    return broadcast_struct<To, S>(table[pick(0)]);
  } else {
    constexpr std::size_t n = sizeof(From) / sizeof(double);
    std::array<S, n> out;
    for (std::size_t k = 0; k < lanes_of<S>; ++k) {
      const auto one = std::bit_cast<std::array<double, n>>(table[pick(k)]);
      for (std::size_t m = 0; m < n; ++m) out[m].v[k] = one[m];
    }
    return std::bit_cast<To>(out);
  }
}

}  // namespace eg
