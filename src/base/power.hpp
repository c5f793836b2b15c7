#pragma once
// a^p for positive a over any number type. Batches have their own logarithm and exponential: branch-free, a few ulp.
#include <cmath>

#include "base/number.hpp"

namespace eg {

/// ln a for a normal number a > 0: a = 2^e m with m near 1, and the series of artanh((m − 1)/(m + 1)).
EG_INLINE Batch logarithm(Batch a) {
  constexpr std::int64_t half_root = 0x3fe6a09e667f3bcd;  // the bits of √½
  const Int8 bits = reinterpret_cast<Int8>(a.v);
  const Int8 exponent = (bits - half_root) >> 52;  // so that m lies in [√½, √2)
  const Batch m = reinterpret_cast<Double8>(bits - (exponent << 52));
  const Batch e = __builtin_convertvector(exponent, Double8);
  const Batch f = (m - Batch(1.0)) / (m + Batch(1.0)), g = f * f;  // g ≤ 0.0295
  Batch series(1.0 / 21);
  for (const double odd : {19., 17., 15., 13., 11., 9., 7., 5., 3.}) series = series * g + Batch(1 / odd);
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
  Batch series(1.0 / 13);
  for (const double k : {12., 11., 10., 9., 8., 7., 6., 5., 4., 3., 2., 1.})
    series = (series * r + Batch(1.0)) * Batch(1 / k);  // Horner of the Taylor series
  const Int8 scale = (reinterpret_cast<Int8>(shifted) + 1023) << 52;
  return (series * r + Batch(1.0)) * Batch(reinterpret_cast<Double8>(scale));
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

/// a^(1/3) for a normal number a > 0: a^(−1/3) guessed from the bits, then two steps of fourth order, and no division.
EG_INLINE Batch cube_root(Batch a) {
  const Double8 bits = __builtin_convertvector(reinterpret_cast<Int8>(a.v), Double8);
  constexpr double guess = 6.14260989173336e18;  // 4/3 of the bits of 1, less what makes the largest error least, 3.4 %
  Batch r = reinterpret_cast<Double8>(__builtin_convertvector(guess - bits * (1.0 / 3.0), Int8));
  for (int step = 0; step < 2; ++step) {
    const Batch h = Batch(1.0) - a * (r * r) * r;
    r = r + r * h * (Batch(1.0 / 3) + h * (Batch(2.0 / 9) + h * Batch(14.0 / 81)));
  }
  return a * (r * r);
}
inline double cube_root(double a) { return std::cbrt(a); }
template <std::size_t N>
Dual<N> cube_root(const Dual<N>& a) {
  Dual<N> c(std::cbrt(a.v));
  for (std::size_t k = 0; k < N; ++k) c.d[k] = c.v / (3 * a.v) * a.d[k];
  return c;
}

}  // namespace eg
