#pragma once
// A 6×6 block by rows of eight lanes, so that products of small matrices are loops over rows.
#include <Eigen/Core>
#include <array>
#include <cmath>

#include "base/batch.hpp"
#include "timestep/sides.hpp"

namespace eg {

struct Tile {
  std::array<Batch, 6> row;  ///< lanes are columns, the last two of them idle

  Tile() { row.fill(Batch(0.0)); }
  explicit Tile(const Block& block) : Tile() {
    for (int r = 0; r < 6; ++r)
      for (int c = 0; c < 6; ++c) at(r, c) = block(r, c);
  }
  double& at(int r, int c) { return reinterpret_cast<double*>(row.data())[8 * r + c]; }
  double at(int r, int c) const { return reinterpret_cast<const double*>(row.data())[8 * r + c]; }

  Block block() const {
    Block b;
    for (int r = 0; r < 6; ++r)
      for (int c = 0; c < 6; ++c) b(r, c) = at(r, c);
    return b;
  }
  /// Frobenius.
  double norm() const {
    Batch squares(0.0);
    for (const Batch& r : row) squares = squares + r * r;
    return std::sqrt(sum(squares));
  }
  double least_diagonal() const {
    double least = at(0, 0);
    for (int r = 1; r < 6; ++r) least = std::min(least, at(r, r));
    return least;
  }
  friend EG_INLINE Tile operator+(Tile a, const Tile& b) {
    for (std::size_t r = 0; r < 6; ++r) a.row[r] = a.row[r] + b.row[r];
    return a;
  }

  /// this −= leftᵀ right. Sums are local, for all that the compiler knows the three are one.
  EG_INLINE void subtract_product(const Tile& left, const Tile& right) {
    const std::array<Batch, 6> factor = right.row;
    for (int r = 0; r < 6; ++r) {
      Batch sum = row[static_cast<std::size_t>(r)];
      for (int k = 0; k < 6; ++k) sum = sum - Batch(left.at(k, r)) * factor[static_cast<std::size_t>(k)];
      row[static_cast<std::size_t>(r)] = sum;
    }
  }
  /// this = L⁻¹ this, by forward substitution.
  EG_INLINE void solve_lower(const Block& lower) {
    for (int r = 0; r < 6; ++r) {
      Batch sum = row[static_cast<std::size_t>(r)];
      for (int k = 0; k < r; ++k) sum = sum - Batch(lower(r, k)) * row[static_cast<std::size_t>(k)];
      row[static_cast<std::size_t>(r)] = sum / Batch(lower(r, r));
    }
  }
};

}  // namespace eg
