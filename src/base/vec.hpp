#pragma once
// Small vectors and matrices over any number type: double, Batch (base/batch.hpp) or Dual (base/dual.hpp).
#include <array>
#include <cmath>
#include <cstdint>

namespace eg {

using Index = std::uint32_t;  ///< number of a grain, contact or wall
inline constexpr Index no_index = ~Index{0};

template <class S>
struct Vec {
  S x{}, y{}, z{};

  Vec& operator+=(const Vec& b) {
    x = x + b.x;
    y = y + b.y;
    z = z + b.z;
    return *this;
  }
  Vec& operator-=(const Vec& b) {
    x = x - b.x;
    y = y - b.y;
    z = z - b.z;
    return *this;
  }
  Vec& operator*=(const S& s) {
    x = x * s;
    y = y * s;
    z = z * s;
    return *this;
  }
  S& operator[](int k) { return k == 0 ? x : k == 1 ? y : z; }
  const S& operator[](int k) const { return k == 0 ? x : k == 1 ? y : z; }
};

template <class S>
Vec<S> operator+(Vec<S> a, const Vec<S>& b) {
  return a += b;
}
template <class S>
Vec<S> operator-(Vec<S> a, const Vec<S>& b) {
  return a -= b;
}
template <class S>
Vec<S> operator-(const Vec<S>& a) {
  return {-a.x, -a.y, -a.z};
}
template <class S>
Vec<S> operator*(Vec<S> a, const S& s) {
  return a *= s;
}
template <class S>
Vec<S> operator*(const S& s, Vec<S> a) {
  return a *= s;
}
template <class S>
S dot(const Vec<S>& a, const Vec<S>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class S>
Vec<S> cross(const Vec<S>& a, const Vec<S>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class S>
S norm(const Vec<S>& a) {
  using std::sqrt;
  return sqrt(dot(a, a));
}

using Vec3 = Vec<double>;

/// 3×3 matrix, row major.
template <class S>
struct Mat {
  std::array<S, 9> a{};

  S& operator()(int i, int j) { return a[static_cast<std::size_t>(3 * i + j)]; }
  const S& operator()(int i, int j) const { return a[static_cast<std::size_t>(3 * i + j)]; }
  Mat& operator+=(const Mat& b) {
    for (std::size_t k = 0; k < 9; ++k) a[k] = a[k] + b.a[k];
    return *this;
  }
  Mat& operator-=(const Mat& b) {
    for (std::size_t k = 0; k < 9; ++k) a[k] = a[k] - b.a[k];
    return *this;
  }
  Mat& operator*=(const S& s) {
    for (auto& v : a) v = v * s;
    return *this;
  }
  static Mat identity() {
    Mat m;
    m(0, 0) = m(1, 1) = m(2, 2) = S(1.0);
    return m;
  }
};

template <class S>
Mat<S> operator+(Mat<S> a, const Mat<S>& b) {
  return a += b;
}
template <class S>
Mat<S> operator-(Mat<S> a, const Mat<S>& b) {
  return a -= b;
}
template <class S>
Mat<S> operator*(const S& s, Mat<S> a) {
  return a *= s;
}
template <class S>
Vec<S> operator*(const Mat<S>& m, const Vec<S>& v) {
  return {m(0, 0) * v.x + m(0, 1) * v.y + m(0, 2) * v.z, m(1, 0) * v.x + m(1, 1) * v.y + m(1, 2) * v.z,
          m(2, 0) * v.x + m(2, 1) * v.y + m(2, 2) * v.z};
}
template <class S>
Mat<S> operator*(const Mat<S>& a, const Mat<S>& b) {
  Mat<S> c;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) c(i, j) = a(i, 0) * b(0, j) + a(i, 1) * b(1, j) + a(i, 2) * b(2, j);
  return c;
}
template <class S>
Mat<S> transpose(const Mat<S>& m) {
  Mat<S> t;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) t(i, j) = m(j, i);
  return t;
}
template <class S>
S trace(const Mat<S>& m) {
  return m(0, 0) + m(1, 1) + m(2, 2);
}
template <class S>
Mat<S> outer(const Vec<S>& a, const Vec<S>& b) {
  Mat<S> m;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) m(i, j) = a[i] * b[j];
  return m;
}
/// Frobenius norm, a bound of the largest stretch.
inline double norm(const Mat<double>& m) {
  double sum = 0;
  for (const double v : m.a) sum += v * v;
  return std::sqrt(sum);
}
template <class S>
S determinant(const Mat<S>& m) {
  return m(0, 0) * (m(1, 1) * m(2, 2) - m(1, 2) * m(2, 1)) - m(0, 1) * (m(1, 0) * m(2, 2) - m(1, 2) * m(2, 0)) +
         m(0, 2) * (m(1, 0) * m(2, 1) - m(1, 1) * m(2, 0));
}
inline Mat<double> inverse(const Mat<double>& m) {
  Mat<double> c;
  const double d = 1.0 / determinant(m);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int i1 = (j + 1) % 3, i2 = (j + 2) % 3, j1 = (i + 1) % 3, j2 = (i + 2) % 3;
      c(i, j) = (m(i1, j1) * m(i2, j2) - m(i1, j2) * m(i2, j1)) * d;
    }
  return c;
}

using Mat3 = Mat<double>;

/// Four doubles that travel together: a vector and one companion scalar (radius, inverse mass …).
struct alignas(32) Quad {
  double x = 0, y = 0, z = 0, w = 0;
  Vec3 vec() const { return {x, y, z}; }
  void set(const Vec3& v) {
    x = v.x;
    y = v.y;
    z = v.z;
  }
};

}  // namespace eg
