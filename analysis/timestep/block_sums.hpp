#pragma once
// The block S_i of a grain as sixteen sums over its sides, and the range of λmax of eight such blocks at once.
#include <array>

#include "timestep/sides.hpp"
#include "timestep/triangle.hpp"

namespace eg {

// Products and roots of traces of positive semidefinite 6×6 matrices: relative error far below this, at any power used.
inline constexpr double power_error = 1e-11;

/// The distinct numbers in Σ w BᵀkB over sides, B = [s 1, a n×]: with e = w(kn − kt), f = s w kt a, h = w kt a²
/// they are Σ e nnᵀ (xx yy zz yz xz xy), Σ w kt, Σ f n and Σ h nnᵀ; n×(1 − nnᵀ)n× = −(1 − nnᵀ) gives the rest.
struct alignas(64) BlockSums {
  Double8 first{};   ///< Σ e nnᵀ, Σ w kt, Σ f x
  Double8 second{};  ///< Σ h nnᵀ, Σ f y, Σ f z
};

/// A spring of couples: k_r (1 − nnᵀ) + k_t nnᵀ on the rotations, which is tr H − H for H = (k_r − k_t) nnᵀ + ½ k_t.
inline void add_couple(BlockSums& sums, const Spring& s, double w) {
  const double excess = w * (s.tangential - s.normal), twist = 0.5 * w * s.normal;
  const Vec3& n = s.n;
  sums.second += Double8{excess * n.x * n.x + twist, excess * n.y * n.y + twist, excess * n.z * n.z + twist,
                         excess * n.y * n.z,         excess * n.x * n.z,         excess * n.x * n.y};
}

EG_INLINE void add_side(BlockSums& sums, const Spring& s, const Side& side, double w) {
  if (s.couple) {
    if (!side.own_image) add_couple(sums, s, w);
    return;
  }
  double e = w * (s.normal - s.tangential), g = w * s.tangential, f, h;
  if (side.own_image) {  // both ends move alike: only the turning is left
    const double arm = s.arm_i + s.arm_j;
    h = g * arm * arm;
    e = g = f = 0;
  } else {
    const bool first = side.matrix == ContactSide::first;
    const double arm = first ? s.arm_i : s.arm_j;
    f = first ? -g * arm : g * arm;
    h = g * arm * arm;
  }
  const Double4 n{s.n.x, s.n.y, s.n.z, 1};
  const Double8 left = __builtin_shufflevector(n, n, 0, 1, 2, 1, 0, 0, 3, 0);
  const Double8 right = __builtin_shufflevector(n, n, 0, 1, 2, 2, 2, 1, 3, 3);
  const Double8 products = left * right;  // xx yy zz yz xz xy 1 x
  const Double8 tail = __builtin_shufflevector(n, n, 0, 0, 0, 0, 0, 0, 1, 2);
  sums.first += products * Double8{e, e, e, e, e, e, g, f};
  sums.second += __builtin_shufflevector(products, tail, 0, 1, 2, 3, 4, 5, 14, 15) * Double8{h, h, h, h, h, h, f, f};
}

/// Sums of eight grains as columns.
EG_INLINE std::array<Batch, 16> columns_of(const std::array<const BlockSums*, 8>& grains) {
  std::array<Batch, 16> s;
  const auto quad = [&](std::size_t k, std::size_t q) { return reinterpret_cast<const Double4*>(grains[k])[q]; };
  for (std::size_t q = 0; q < 4; ++q) {
    const auto pair = [&](std::size_t k) { return join(quad(k, q), quad(k + 4, q)); };
    const auto columns = transpose_rows({pair(0), pair(1), pair(2), pair(3)});
    s[4 * q] = columns.x, s[4 * q + 1] = columns.y, s[4 * q + 2] = columns.z, s[4 * q + 3] = columns.w;
  }
  return s;
}

/// M^−½ (…) M^−½ from the sums and the scales of eight grains.
EG_INLINE Triangle scaled_blocks(const std::array<Batch, 16>& s, const std::array<Batch, 6>& d) {
  Triangle x;
  const Batch fx = s[7], fy = s[14], fz = s[15], turn = s[8] + s[9] + s[10];
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c <= r; ++c) {
      const std::size_t place = r == c ? r : 6 - r - c;  // xx yy zz yz xz xy
      const Batch e = s[place], h = s[8 + place];
      x(r, c) = d[r] * d[c] * (r == c ? e + s[6] : e);
      x(3 + r, 3 + c) = d[3 + r] * d[3 + c] * (r == c ? turn - h : -h);
    }
  const Batch zero(0.0);
  const Batch cross[3][3] = {{zero, -fz, fy}, {fz, zero, -fx}, {-fy, fx, zero}};
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < 3; ++c) x(3 + c, r) = d[r] * d[3 + c] * cross[r][c];
  return x;
}

struct EightRanges {
  Batch low, high;
};

EG_INLINE EightRanges range_of(Triangle block) {
  const Batch scale = normalise(block);
  Triangle power = block;
  Batch trace[4];
  for (Batch& each : trace) {
    power = square(power);
    each = normalise(power);
  }
  const Batch low = scale * trace_of_product(power, block);
  const Batch last = trace_of_product(power, power);
  const Batch root = sqrt(trace[0] * sqrt(trace[1] * sqrt(trace[2] * sqrt(trace[3] * sqrt(last)))));
  return {low, scale * root * Batch(1 + power_error)};
}

/// (tr A⁴)^¼ of a symmetric 3×3 matrix, ≥ λmax.
EG_INLINE Batch fourth_norm(Batch xx, Batch yy, Batch zz, Batch yz, Batch xz, Batch xy) {
  const Batch a = xx * xx + xy * xy + xz * xz, b = xy * xy + yy * yy + yz * yz, c = xz * xz + yz * yz + zz * zz;
  const Batch d = xy * xz + yy * yz + yz * zz, e = xx * xz + xy * yz + xz * zz, f = xx * xy + xy * yy + xz * yz;
  return sqrt(sqrt(a * a + b * b + c * c + Batch(2.0) * (d * d + e * e + f * f)));
}

/// An upper end of λmax that costs a fraction of that, mostly 1.1 to 1.3 times as large: the norm of the 2×2 matrix of
/// the norms of translations, rotations and what is between them. The scales are 1/m and 1/I.
EG_INLINE Batch rough_bound(const std::array<Batch, 16>& s, Batch inverse_mass, Batch inverse_inertia) {
  const Batch sum = s[8] + s[9] + s[10];
  const Batch shift = inverse_mass * fourth_norm(s[0] + s[6], s[1] + s[6], s[2] + s[6], s[3], s[4], s[5]);
  const Batch turn = inverse_inertia * fourth_norm(sum - s[8], sum - s[9], sum - s[10], s[11], s[12], s[13]);
  const Batch cross = inverse_mass * inverse_inertia * (s[7] * s[7] + s[14] * s[14] + s[15] * s[15]);
  const Batch half(0.5), apart = half * (shift - turn);
  return (half * (shift + turn) + sqrt(apart * apart + cross)) * Batch(1 + power_error);
}

}  // namespace eg
