#pragma once
// The periodic cell, triclinic: edge vectors are the columns of an upper-triangular matrix H. A direction that is not
// periodic keeps its edge only as the size of the specimen's box.
#include <array>
#include <cstdint>

#include "base/vec.hpp"

namespace eg {

struct Cell {
  static constexpr std::uint8_t home = 13;  ///< image code of the cell itself
  static constexpr std::size_t images = 27;

  Mat3 h = Mat3::identity();  ///< columns a, b, c [m]; h(1,0) = h(2,0) = h(2,1) = 0
  Mat3 h_low;                 ///< what h has lost to round-off so far (compensated sum), see deform()
  std::array<bool, 3> periodic{false, false, false};
  Vec3 origin;      ///< lower corner [m]
  Mat3 strain;      ///< ∫ L dt since the stage began [-]: logarithmic along the axes, tension positive
  Mat3 strain_low;  ///< its compensation
  Mat3 rate;        ///< velocity gradient L [1/s], upper triangular, tension positive

  bool any_periodic() const { return periodic[0] || periodic[1] || periodic[2]; }
  /// Code of the image displaced by (s0, s1, s2) edges, each −1, 0 or 1.
  static std::uint8_t code(int s0, int s1, int s2) { return static_cast<std::uint8_t>(13 + s0 + 3 * s1 + 9 * s2); }
  static std::array<int, 3> steps(std::uint8_t code) { return {code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1}; }
  /// Translation of an image [m].
  Vec3 shift(std::uint8_t code) const {
    const auto s = steps(code);
    return h * Vec3{double(s[0]), double(s[1]), double(s[2])};
  }
  double volume() const { return h(0, 0) * h(1, 1) * h(2, 2); }  ///< [m³]; 2D: h(2,2) = 1, so area per metre
  /// Perpendicular width along direction k [m]: distance of the two faces that edge k joins.
  double width(int k) const;
  /// Fractional coordinates of a point.
  Vec3 fractional(const Vec3& x) const { return inverse(h) * (x - origin); }
  /// H ← exp(L dt) H, compensated, so that strain increments far below round-off of H still add up and a rate
  /// without trace keeps the volume. Returns exp(L dt) − 1, by which points move with the cell.
  Mat3 deform(double dt);
  /// Replaces edges by equivalent ones of the same lattice so that no edge leans by more than half of another: b − n_xy
  /// a and c − n_yz b − n_xz a. Returns {n_yz, n_xz, n_xy}; images change with them, see renamed().
  std::array<int, 3> straighten();
  /// Steps of an image along the edges after straighten() has returned `n`.
  static std::array<int, 3> renamed(const std::array<int, 3>& steps, const std::array<int, 3>& n) {
    return {steps[0] + steps[1] * n[2] + steps[2] * (n[1] + n[0] * n[2]), steps[1] + steps[2] * n[0], steps[2]};
  }
};

}  // namespace eg
