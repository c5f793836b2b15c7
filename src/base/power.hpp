#pragma once
// a^p for positive a over any number type. Batches have their own logarithm and exponential: branch-free, a few ulp.
#include <cmath>

#include "base/number.hpp"

namespace eg {

/// a + b x. Series are summed in pairs of terms, pairs of pairs …, so that no term waits for all before it.
EG_INLINE Batch line(double a, double b, Batch x) { return Batch(a) + Batch(b) * x; }

/// log2 a for a normal number a > 0: a = 2^e m with m near 1, and the series of artanh((m − 1)/(m + 1)).
EG_INLINE Batch binary_logarithm(Batch a) {
  constexpr std::int64_t half_root = 0x3fe6a09e667f3bcd;  // the bits of √½
  constexpr double two = 2.885390081777926814720;         // 2/ln 2
  const Int8 bits = reinterpret_cast<Int8>(a.v);
  const Int8 exponent = (bits - half_root) >> 52;  // so that m lies in [√½, √2)
  const Batch m = reinterpret_cast<Double8>(bits - (exponent << 52));
  const Batch e = __builtin_convertvector(exponent, Double8);
  const Batch f = quotient(m - Batch(1.0), m + Batch(1.0)), g = f * f, g2 = g * g, g4 = g2 * g2;  // g ≤ 0.0295
  const Batch low = line(two / 3, two / 5, g) + g2 * line(two / 7, two / 9, g);
  const Batch middle = line(two / 11, two / 13, g) + g2 * line(two / 15, two / 17, g);
  const Batch series = low + g4 * (middle + g4 * Batch(two / 19));
  return e + f * (Batch(two) + g * series);
}

/// 2^(p l) for |p l| < 1000, the product not rounded before its whole part is off.
EG_INLINE Batch binary_power(Batch p, Batch l) {
  constexpr double shift = 0x1.8p52;  // adding it rounds to a whole number
  constexpr double c1 = 0.693147180559945309417, c2 = c1 * c1 / 2, c3 = c2 * c1 / 3, c4 = c3 * c1 / 4, c5 = c4 * c1 / 5,
                   c6 = c5 * c1 / 6, c7 = c6 * c1 / 7, c8 = c7 * c1 / 8, c9 = c8 * c1 / 9, c10 = c9 * c1 / 10,
                   c11 = c10 * c1 / 11, c12 = c11 * c1 / 12, c13 = c12 * c1 / 13;
  const Double8 shifted = p.v * l.v + shift;
  const Batch n = shifted - shift;
  const Batch r = p * l - n, r2 = r * r, r4 = r2 * r2;  // |r| ≤ ½; Taylor series
  const Batch low = line(c2, c3, r) + r2 * line(c4, c5, r);
  const Batch middle = line(c6, c7, r) + r2 * line(c8, c9, r);
  const Batch high = line(c10, c11, r) + r2 * line(c12, c13, r);
  const Batch rest = r * Batch(c1) + r2 * (low + r4 * (middle + r4 * high));
  const Batch scale = reinterpret_cast<Double8>((reinterpret_cast<Int8>(shifted) + 1023) << 52);
  return scale + scale * rest;
}

/// a^p for a > 0 and |p log2 a| < 1000; p carries no derivative.
EG_INLINE Batch power(Batch a, Batch p) { return binary_power(p, binary_logarithm(a)); }
inline double power(double a, double p) { return std::pow(a, p); }
template <std::size_t N>
Dual<N> power(const Dual<N>& a, const Dual<N>& p) {
  Dual<N> c(std::pow(a.v, p.v));
  for (std::size_t k = 0; k < N; ++k) c.d[k] = p.v * c.v / a.v * a.d[k];
  return c;
}

/// a^(−1/3) for a normal number a > 0: guessed from the bits, then two steps of fourth order, and no division.
EG_INLINE Batch inverse_cube_root(Batch a) {
  const Double8 bits = __builtin_convertvector(reinterpret_cast<Int8>(a.v), Double8);
  constexpr double guess = 6.14260989173336e18;  // 4/3 of the bits of 1, less what makes the largest error least, 3.4 %
  Batch r = reinterpret_cast<Double8>(__builtin_convertvector(guess - bits * (1.0 / 3.0), Int8));
  for (int step = 0; step < 2; ++step) {
    const Batch h = Batch(1.0) - (r * r) * (a * r);
    r = r + (r * h) * (line(1.0 / 3, 2.0 / 9, h) + (h * h) * Batch(14.0 / 81));
  }
  return r;
}
inline double inverse_cube_root(double a) { return 1 / std::cbrt(a); }
template <std::size_t N>
Dual<N> inverse_cube_root(const Dual<N>& a) {
  Dual<N> c(1 / std::cbrt(a.v));
  for (std::size_t k = 0; k < N; ++k) c.d[k] = -c.v / (3 * a.v) * a.d[k];
  return c;
}

}  // namespace eg
