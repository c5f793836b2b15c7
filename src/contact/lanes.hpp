#pragma once
// Loads and stores of grain rows for one contact (S = double) or eight (S = Batch), so that one loop serves both.
#include <bit>

#include "base/number.hpp"

namespace eg {

template <class S>
struct Columns {
  S x, y, z, w;
};

/// Lanes of a batch in memory.
EG_INLINE const double* lanes_at(const Batch& b) { return reinterpret_cast<const double*>(&b); }
EG_INLINE const double* lanes_at(const double& b) { return &b; }
EG_INLINE Double4 quad_vector(const Quad& q) { return *reinterpret_cast<const Double4*>(&q); }

/// Rows a and b side by side.
EG_INLINE Double8 row_pair(const Quad* rows, std::size_t a, std::size_t b) {
  return join(quad_vector(rows[a]), quad_vector(rows[b]));
}

/// Differences (j − i) of x, y, z and the sum of w: combined before they are transposed, which is what costs.
template <class S>
EG_INLINE Columns<S> load_difference(const Quad* rows, const Index* i, const Index* j) {
  if constexpr (lanes_of<S> == 1) {
    const Vec3 d = rows[j[0]].vec() - rows[i[0]].vec();
    return {d.x, d.y, d.z, rows[j[0]].w + rows[i[0]].w};
  } else {
    const Double8 sign{-1, -1, -1, 1, -1, -1, -1, 1};
    Double8 t[4];
    for (std::size_t k = 0; k < 4; ++k) t[k] = row_pair(rows, j[k], j[k + 4]) + sign * row_pair(rows, i[k], i[k + 4]);
    const auto c = transpose_rows(t);
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
    Double8 t[4];
    for (std::size_t k = 0; k < 4; ++k) t[k] = row_pair(rows, index[k], index[k + 4]);
    const auto c = transpose_rows(t);
    return {c.x, c.y, c.z, c.w};
  }
}

/// Position, velocity and spin of both sides of a contact.
template <class S>
struct BothSides {
  Columns<S> branch;    ///< x_j + shift[image] − x_i; w = R_i + R_j
  Columns<S> velocity;  ///< v_j − v_i; w = 1/m_i + 1/m_j
  Columns<S> spin_i, spin_j;
  S radius_i;
};

/// `image` null: no shifts. All rows of one lane are read together, so that its place is worked out once.
template <bool rotation, class S>
EG_INLINE void load_sides(BothSides<S>& out, const Quad* position, const Quad* velocity, const Quad* spin,
                          const Index* i, const Index* j, const Quad* shift, const std::uint8_t* image) {
  if constexpr (lanes_of<S> == 1) {
    out.branch = load_difference<S>(position, i, j), out.velocity = load_difference<S>(velocity, i, j);
    out.radius_i = position[i[0]].w;
    if (image) {
      const Quad& s = shift[image[0]];
      out.branch.x += s.x, out.branch.y += s.y, out.branch.z += s.z;
    }
    if constexpr (rotation) out.spin_i = load_rows<S>(spin, i), out.spin_j = load_rows<S>(spin, j);
  } else {
    const Double8 sign{-1, -1, -1, 1, -1, -1, -1, 1};
    Double8 x[4], xi[4], v[4], wi[4], wj[4];
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t ia = i[k], ib = i[k + 4], ja = j[k], jb = j[k + 4];
      xi[k] = row_pair(position, ia, ib);
      x[k] = row_pair(position, ja, jb) + sign * xi[k];
      v[k] = row_pair(velocity, ja, jb) + sign * row_pair(velocity, ia, ib);
      if constexpr (rotation) wi[k] = row_pair(spin, ia, ib), wj[k] = row_pair(spin, ja, jb);
    }
    if (image)
      for (std::size_t k = 0; k < 4; ++k) x[k] += row_pair(shift, image[k], image[k + 4]);
    const auto put = [](Columns<S>& to, const QuadColumns& c) { to.x = c.x, to.y = c.y, to.z = c.z, to.w = c.w; };
    put(out.branch, transpose_rows(x)), put(out.velocity, transpose_rows(v));
    out.radius_i = transpose_w(xi);
    if constexpr (rotation) put(out.spin_i, transpose_rows(wi)), put(out.spin_j, transpose_rows(wj));
  }
}

/// Adds a contact to the accumulators of both sides: −f to i and f to j, with the moment times each arm behind it when
/// `stride` is 2. Lane after lane, so that one grain may stand in several.
template <std::size_t stride, class S>
EG_INLINE void add_contact(Quad* rows, const Index* i, const Index* j, const Vec<S>& f, const Vec<S>& moment,
                           const double* arm_i, const double* arm_j) {
  if constexpr (lanes_of<S> == 1) {
    const auto add = [](Quad& q, const Vec3& v) { q.set(q.vec() + v); };
    add(rows[stride * i[0]], -f), add(rows[stride * j[0]], f);
    if constexpr (stride == 2) add(rows[2 * i[0] + 1], moment * *arm_i), add(rows[2 * j[0] + 1], moment * *arm_j);
  } else if constexpr (stride == 2) {
    const auto at = [rows](std::size_t k) -> Double8& { return *reinterpret_cast<Double8*>(rows + 2 * k); };
    Double8 row[8];
    transpose_columns({f.x, f.y, f.z, Batch(0.0)}, {moment.x, moment.y, moment.z, Batch(0.0)}, row);
    for (std::size_t k = 0; k < 8; ++k) {
      at(i[k]) += row[k] * halves(-1, arm_i[k]);
      at(j[k]) += row[k] * halves(1, arm_j[k]);
    }
  } else {
    const auto at = [rows](std::size_t k) -> Double4& { return *reinterpret_cast<Double4*>(rows + k); };
    Double4 force[8];
    transpose_columns({f.x, f.y, f.z, Batch(0.0)}, force);
    for (std::size_t k = 0; k < 8; ++k) at(i[k]) -= force[k], at(j[k]) += force[k];
  }
}

/// The same with a couple behind each moment: +couple to i, −couple to j.
template <class S>
EG_INLINE void add_contact_with_couple(Quad* rows, const Index* i, const Index* j, const Vec<S>& f,
                                       const Vec<S>& moment, const S& arm_i, const S& arm_j, const Vec<S>& couple) {
  if constexpr (lanes_of<S> == 1) {
    const auto add = [](Quad& q, const Vec3& v) { q.set(q.vec() + v); };
    add(rows[2 * i[0]], -f), add(rows[2 * i[0] + 1], moment * arm_i + couple);
    add(rows[2 * j[0]], f), add(rows[2 * j[0] + 1], moment * arm_j - couple);
  } else {
    Double4 force[8], first[8], second[8];
    transpose_columns({f.x, f.y, f.z, Batch(0.0)}, force);
    const Vec<S> on_i = moment * arm_i + couple, on_j = moment * arm_j - couple;
    transpose_columns({on_i.x, on_i.y, on_i.z, Batch(0.0)}, first);
    transpose_columns({on_j.x, on_j.y, on_j.z, Batch(0.0)}, second);
    const auto at = [rows](std::size_t k) -> Double4& { return *reinterpret_cast<Double4*>(rows + k); };
    for (std::size_t k = 0; k < 8; ++k) {
      at(2 * i[k]) -= force[k], at(2 * i[k] + 1) += first[k];
      at(2 * j[k]) += force[k], at(2 * j[k] + 1) += second[k];
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
