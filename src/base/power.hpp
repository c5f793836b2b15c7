#pragma once
// a^p for positive a over any number type. Batches have their own logarithm and exponential: branch-free, a few ulp.
#include <cmath>

#include "base/number.hpp"

namespace eg {

/// a + b x. Series are summed in pairs of terms, pairs of pairs …, so that no term waits for all before it.
EG_INLINE Batch line(double a, double b, Batch x) { return Batch(a) + Batch(b) * x; }

/// ln a for a normal number a > 0: a = 2^e m with m near 1, and the series of artanh((m − 1)/(m + 1)).
EG_INLINE Batch logarithm(Batch a) {
  constexpr std::int64_t half_root = 0x3fe6a09e667f3bcd;  // the bits of √½
  const Int8 bits = reinterpret_cast<Int8>(a.v);
  const Int8 exponent = (bits - half_root) >> 52;  // so that m lies in [√½, √2)
  const Batch m = reinterpret_cast<Double8>(bits - (exponent << 52));
  const Batch e = __builtin_convertvector(exponent, Double8);
  const Batch f = (m - Batch(1.0)) * reciprocal(m + Batch(1.0)), g = f * f;  // g ≤ 0.0295
  const Batch g2 = g * g, g4 = g2 * g2;
  const Batch low = line(1.0 / 3, 1.0 / 5, g) + g2 * line(1.0 / 7, 1.0 / 9, g);
  const Batch middle = line(1.0 / 11, 1.0 / 13, g) + g2 * line(1.0 / 15, 1.0 / 17, g);
  const Batch series = low + g4 * (middle + g4 * line(1.0 / 19, 1.0 / 21, g));
  constexpr double ln2_high = 0x1.62e42fefa3800p-1, ln2_low = 0x1.ef35793c76730p-45;  // their sum is ln 2
  return e * Batch(ln2_high) + (f + f + (e * Batch(ln2_low) + f * g * series * Batch(2.0)));
}

/// eˣ; x is held within ±700.
EG_INLINE Batch exponential(Batch x) {
  x = max(min(x, Batch(700.0)), Batch(-700.0));
  constexpr double shift = 0x1.8p52;  // adding it rounds to a whole number
  constexpr double ln2_high = 0x1.62e42fefa3800p-1, ln2_low = 0x1.ef35793c76730p-45;
  const Double8 shifted = x.v * 0x1.71547652b82fep+0 + shift;
  const Batch n = shifted - shift;
  const Batch r = (x - n * Batch(ln2_high)) - n * Batch(ln2_low);  // |r| ≤ ½ ln 2
  const Batch r2 = r * r, r4 = r2 * r2;                            // Taylor series from r² on
  const Batch low = line(1.0 / 2, 1.0 / 6, r) + r2 * line(1.0 / 24, 1.0 / 120, r);
  const Batch middle = line(1.0 / 720, 1.0 / 5040, r) + r2 * line(1.0 / 40320, 1.0 / 362880, r);
  const Batch high = line(1.0 / 3628800, 1.0 / 39916800, r) + r2 * line(1.0 / 479001600, 1.0 / 6227020800, r);
  const Batch rest = r2 * (low + r4 * (middle + r4 * high));
  const Int8 scale = (reinterpret_cast<Int8>(shifted) + 1023) << 52;
  return (Batch(1.0) + (r + rest)) * Batch(reinterpret_cast<Double8>(scale));
}

/// a^p for a > 0; p carries no derivative.
EG_INLINE Batch power(Batch a, Batch p) { return exponential(p * logarithm(a)); }
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
    const Batch h = Batch(1.0) - a * (r * r) * r;
    r = r + r * h * (Batch(1.0 / 3) + h * (Batch(2.0 / 9) + h * Batch(14.0 / 81)));
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
