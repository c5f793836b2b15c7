#pragma once
// What a contact law may ask of its number type S, be it double, Batch or Dual: + − * /, sqrt, <, >, select, max, min,
// any.
#include <cmath>

#include "base/batch.hpp"
#include "base/dual.hpp"

namespace eg {

template <class S>
EG_INLINE S select(bool choose, const S& yes, const S& no) {
  return choose ? yes : no;
}
inline bool any(bool b) { return b; }
template <class S>
EG_INLINE S max(const S& a, const S& b) {
  return select(a < b, b, a);
}
template <class S>
EG_INLINE S min(const S& a, const S& b) {
  return select(b < a, b, a);
}
using std::sqrt;
template <class S>
EG_INLINE S rsqrt(const S& a) {
  return S(1.0) / sqrt(a);
}
template <class S>
EG_INLINE S reciprocal(const S& a) {
  return S(1.0) / a;
}

/// √a for a ≥ 0, through rsqrt.
EG_INLINE Batch root(Batch a) { return a * rsqrt(max(a, Batch(1e-300))); }
template <class S>
EG_INLINE S root(const S& a) {
  return sqrt(a);
}

/// √(a/b) for a ≥ 0, b > 0, without a division.
EG_INLINE Batch root_of_ratio(Batch a, Batch b) { return a * rsqrt(max(a * b, Batch(1e-300))); }
template <class S>
EG_INLINE S root_of_ratio(const S& a, const S& b) {
  return sqrt(a / b);
}

/// 1/√(1 − e): for batches by a series, exact to round-off for |e| < 1e-4.
EG_INLINE Batch rsqrt_near_one(Batch e) {
  return Batch(1.0) + e * (Batch(0.5) + e * (Batch(0.375) + e * Batch(0.3125)));
}
template <class S>
EG_INLINE S rsqrt_near_one(const S& e) {
  return rsqrt(max(S(1.0) - e, S(1e-300)));
}
template <class S>
EG_INLINE S rough_reciprocal(const S& a) {
  return S(1.0) / a;
}

template <class S>
inline constexpr std::size_t lanes_of = 1;
template <>
inline constexpr std::size_t lanes_of<Batch> = Batch::lanes;

template <class S>
EG_INLINE Vec<S> select(bool m, const Vec<S>& yes, const Vec<S>& no) {
  return m ? yes : no;
}
EG_INLINE Vec<Batch> select(Mask m, const Vec<Batch>& yes, const Vec<Batch>& no) {
  return {select(m, yes.x, no.x), select(m, yes.y, no.y), select(m, yes.z, no.z)};
}

}  // namespace eg
