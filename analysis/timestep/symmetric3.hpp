#pragma once
// Symmetric 3×3 matrices of eight contacts at once: what the sweeps over matrix weights are made of.
#include "base/batch.hpp"

namespace eg {

struct Symmetric3 {
  Batch xx, yy, zz, yz, xz, xy;

  friend EG_INLINE Symmetric3 operator+(const Symmetric3& a, const Symmetric3& b) {
    return {a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.yz + b.yz, a.xz + b.xz, a.xy + b.xy};
  }
  friend EG_INLINE Symmetric3 operator*(const Symmetric3& a, Batch s) {
    return {a.xx * s, a.yy * s, a.zz * s, a.yz * s, a.xz * s, a.xy * s};
  }
  EG_INLINE Batch trace() const { return xx + yy + zz; }
  EG_INLINE Batch frobenius() const {
    return sqrt(xx * xx + yy * yy + zz * zz + (yz * yz + xz * xz + xy * xy) * Batch(2.0));
  }
  EG_INLINE Symmetric3 plus_identity(Batch s) const { return {xx + s, yy + s, zz + s, yz, xz, xy}; }
  EG_INLINE Vec<Batch> times(const Vec<Batch>& v) const {
    return {xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z, xz * v.x + yz * v.y + zz * v.z};
  }
};

EG_INLINE Symmetric3 inverse(const Symmetric3& a) {
  const Symmetric3 adjugate{a.yy * a.zz - a.yz * a.yz, a.xx * a.zz - a.xz * a.xz, a.xx * a.yy - a.xy * a.xy,
                            a.xz * a.xy - a.xx * a.yz, a.xy * a.yz - a.yy * a.xz, a.xz * a.yz - a.zz * a.xy};
  const Batch determinant = a.xx * adjugate.xx + a.xy * adjugate.xy + a.xz * adjugate.xz;
  return adjugate * (Batch(1.0) / determinant);
}

/// Positive definite beyond doubt: every leading minor is larger than 1e-12 of the terms that it is the sum of, which
/// round-off cannot bring about.
EG_INLINE Mask is_positive(const Symmetric3& a) {
  const Batch zero(0.0), sure(1e-12), xy2 = a.xy * a.xy, xz2 = a.xz * a.xz, yz2 = a.yz * a.yz;
  const Batch two = a.xx * a.yy, three = two * a.zz, mixed = Batch(2.0) * (a.xy * a.yz * a.xz);
  const Batch taken = a.xx * yz2 + a.yy * xz2 + a.zz * xy2;
  return (a.xx > zero) & (a.yy > zero) & (a.zz > zero) & (two - xy2 > sure * (two + xy2)) &
         (three + mixed - taken > sure * (three + abs(mixed) + taken));
}

/// ‖A B − 1‖, Frobenius.
EG_INLINE Batch distance_from_inverse(const Symmetric3& a, const Symmetric3& b) {
  const Vec<Batch> x = a.times({b.xx, b.xy, b.xz}), y = a.times({b.xy, b.yy, b.yz}), z = a.times({b.xz, b.yz, b.zz});
  const Batch one(1.0), dx = x.x - one, dy = y.y - one, dz = z.z - one;
  return sqrt(dx * dx + dy * dy + dz * dz + x.y * x.y + x.z * x.z + y.x * y.x + y.z * y.z + z.x * z.x + z.y * z.y);
}

/// A # B, the geometric mean of positive definite matrices, as the common limit of their arithmetic and harmonic means
/// (Anderson, Morley and Trapp 1984); a few steps bring it near enough for a choice of weights.
EG_INLINE Symmetric3 geometric_mean(Symmetric3 a, Symmetric3 b, int steps) {
  for (int k = 0; k < steps; ++k) {
    const Symmetric3 sum = a + b;
    b = inverse(inverse(a) + inverse(b)) * Batch(2.0);
    a = sum * Batch(0.5);
  }
  return (a + b) * Batch(0.5);
}

/// (p 1 + q nnᵀ) A (p 1 + q nnᵀ)
EG_INLINE Symmetric3 sandwich(const Symmetric3& a, Batch p, Batch q, const Vec<Batch>& n) {
  const Vec<Batch> an = a.times(n);
  const Batch cross = p * q, square = q * q * dot(n, an), two(2.0);
  const Symmetric3 outer{n.x * n.x, n.y * n.y, n.z * n.z, n.y * n.z, n.x * n.z, n.x * n.y};
  const Symmetric3 mixed{two * an.x * n.x,        two * an.y * n.y,        two * an.z * n.z,
                         an.y * n.z + an.z * n.y, an.x * n.z + an.z * n.x, an.x * n.y + an.y * n.x};
  return a * (p * p) + mixed * cross + outer * square;
}

}  // namespace eg
