#pragma once
// A value with its first derivatives along N directions (forward automatic differentiation). Plain values, no
// expression types, so that select() and the laws take it like a double.
#include <array>
#include <cmath>
#include <cstddef>

namespace eg {

template <std::size_t N>
struct Dual {
  double v = 0;
  std::array<double, N> d{};

  Dual() = default;
  Dual(double value) : v(value) {}
  static Dual variable(double value, std::size_t k) {
    Dual x(value);
    x.d[k] = 1;
    return x;
  }

  friend Dual operator+(Dual a, const Dual& b) {
    a.v += b.v;
    for (std::size_t k = 0; k < N; ++k) a.d[k] += b.d[k];
    return a;
  }
  friend Dual operator-(Dual a, const Dual& b) {
    a.v -= b.v;
    for (std::size_t k = 0; k < N; ++k) a.d[k] -= b.d[k];
    return a;
  }
  friend Dual operator-(Dual a) { return Dual(0.0) - a; }
  friend Dual operator*(const Dual& a, const Dual& b) {
    Dual c(a.v * b.v);
    for (std::size_t k = 0; k < N; ++k) c.d[k] = a.d[k] * b.v + a.v * b.d[k];
    return c;
  }
  friend Dual operator/(const Dual& a, const Dual& b) {
    Dual c(a.v / b.v);
    for (std::size_t k = 0; k < N; ++k) c.d[k] = (a.d[k] - c.v * b.d[k]) / b.v;
    return c;
  }
  friend Dual sqrt(const Dual& a) {
    Dual c(std::sqrt(a.v));
    for (std::size_t k = 0; k < N; ++k) c.d[k] = a.d[k] / (2 * c.v);
    return c;
  }
  friend bool operator<(const Dual& a, const Dual& b) { return a.v < b.v; }
  friend bool operator>(const Dual& a, const Dual& b) { return a.v > b.v; }
};

}  // namespace eg
