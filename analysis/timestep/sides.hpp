#pragma once
// A contact seen from its grains. Every bound on λmax(M^−½KM^−½) that works grain by grain starts from these.
//
// With k the contact stiffness, B the side matrix and A = k^½ B M^−½ (3×6), the block of a grain is Σ Aᵀ W A over its
// sides with a weight W (3×3, symmetric) for each.
#include <Eigen/Core>
#include <cmath>
#include <span>
#include <vector>

#include "assembly/network.hpp"
#include "assembly/stiffness.hpp"

namespace eg {

using Block = Eigen::Matrix<double, 6, 6>;

struct Side {
  enum class Role : std::uint8_t {
    first,   ///< grain i of a contact of two movable grains
    second,  ///< grain j of such a contact
    alone,   ///< the other side is a wall or cannot move, or is the grain's own image: nothing to split
  };
  Index spring = 0;
  Role role = Role::first;
  ContactSide matrix = ContactSide::first;  ///< which B; unused when own_image
  bool own_image = false;                   ///< i == j: B_i + B_j
};

/// Sides of all grains, grain after grain, in the order of the springs. Grains that cannot move have none.
class Sides {
 public:
  explicit Sides(const Network& network);

  const Network& network() const { return network_; }
  std::size_t size() const { return begin_.size() - 1; }
  std::span<const Side> of(std::size_t grain) const {
    return std::span(sides_).subspan(begin_[grain], begin_[grain + 1] - begin_[grain]);
  }
  /// Whether a contact joins two different grains that can move.
  bool is_split(std::size_t spring) const { return split_[spring] != 0; }

  struct Lever {
    double sign, arm;  ///< B = [sign 1, arm n×]
  };
  static Lever lever_of(const Spring& s, const Side& side) {
    if (side.own_image) return {0, s.arm_i + s.arm_j};
    return side.matrix == ContactSide::first ? Lever{-1, s.arm_i} : Lever{1, s.arm_j};
  }

  /// M^−½ of a grain; 0 for what is not a degree of freedom.
  Eigen::Matrix<double, 6, 1> scale(std::size_t grain) const;

  /// B M^−½ of a side; columns of what is not a degree of freedom are 0.
  Eigen::Matrix<double, 3, 6> scaled_matrix(std::size_t grain, const Side& side) const;

  /// Σ (BM^−½)ᵀ C (BM^−½) over the sides of a grain, with the contact's symmetric 3×3 matrix C = stiffness(side).
  template <class Stiffness>
  Block block(std::size_t grain, Stiffness stiffness) const {
    Block sum = Block::Zero();
    for (const Side& side : of(grain)) {
      const Spring& s = network_.springs[side.spring];
      const Eigen::Matrix3d c = stiffness(side);
      if (s.couple) {  // B = [0, ±1]
        if (!side.own_image) sum.bottomRightCorner<3, 3>() += c;
        continue;
      }
      const Lever lever = lever_of(s, side);  // B = [sign, a n×]
      Eigen::Matrix3d arm;
      arm << 0, -s.n.z, s.n.y, s.n.z, 0, -s.n.x, -s.n.y, s.n.x, 0;
      arm *= lever.arm;
      const Eigen::Matrix3d turned = c.lazyProduct(arm);
      sum.topLeftCorner<3, 3>() += std::abs(lever.sign) * c;
      sum.topRightCorner<3, 3>() += lever.sign * turned;
      sum.bottomRightCorner<3, 3>() -= arm.lazyProduct(turned);
    }
    sum.bottomLeftCorner<3, 3>() = sum.topRightCorner<3, 3>().transpose();
    const Eigen::Matrix<double, 6, 1> d = scale(grain);
    return d.asDiagonal() * sum * d.asDiagonal();
  }

 private:
  const Network& network_;
  Eigen::Matrix<double, 6, 1> active_;  ///< 1 for degrees of freedom of this dimension, 0 for the rest
  std::vector<std::uint32_t> begin_;
  std::vector<Side> sides_;
  std::vector<char> split_;
};

/// A number that the largest eigenvalue of a grain's block cannot exceed, summation of the block from `terms` sides
/// included. Relative excess about 1e-13.
double block_upper_bound(const Block& block, std::size_t terms);

/// True only if the largest eigenvalue is below sigma: Cholesky of σ − block succeeds with a margin for round-off
/// (Demmel 1989). Far cheaper than block_upper_bound().
bool block_is_below(const Block& block, std::size_t terms, double sigma);

}  // namespace eg
