#pragma once
// The weights of contact splitting, and the sweeps that improve 3×3 ones.
#include <Eigen/Core>
#include <array>
#include <vector>

#include "timestep/block_ranges.hpp"
#include "timestep/splitting.hpp"
#include "timestep/symmetric3.hpp"

namespace eg {

/// The contacts of a network with the splitting weight of each.
class WeightedContacts {
 public:
  WeightedContacts(const Sides& sides, SplittingWeights weights);

  const Sides& sides() const { return sides_; }
  const SplittingWeights& weights() const { return weights_; }
  void set_weights(SplittingWeights weights);

  /// The grains of contacts that have matrices, ascending.
  const std::vector<Index>& matrix_grains() const { return grains_; }

  /// What a side weighs: k^½ (1 + T^±1) k^½, k for one that has nothing to split.
  Eigen::Matrix3d weighted_stiffness(const Side& side) const;

  /// S_i.
  Block block(std::size_t grain) const {
    return sides_.block(grain, [this](const Side& side) { return weighted_stiffness(side); });
  }

  /// Gives a matrix (its scalar, at first) to every split contact of a grain with lambda above hot × maximum; contacts
  /// that have one keep it.
  void make_matrices(const std::vector<double>& lambda, double hot);

  /// Makes the ranges true for the blocks that have matrices in them; block_ranges() knows the rest.
  void update(BlockRanges& ranges) const;

  /// The greatest λmax(S_i), round-off included, and whose it is: λmax(M⁻¹K) is not above. Ranges as update() leaves
  /// them.
  SplittingBound bound(const BlockRanges& ranges) const;

  /// One step of all matrices towards the minimum of Σ tr S_i^(q+1), q = 2^squarings. Stationarity is T A T = B with
  /// A = A_i S_i^q A_iᵀ and B = A_j S_j^q A_jᵀ, so T* = A⁻¹ # B, the geometric mean (Bhatia 2007); T goes a small part
  /// of the way to T*, because all neighbours move at once, and on by part of its last step (Polyak 1964). Eight
  /// contacts at a time, the same for any number of threads.
  void sweep(int squarings);

 private:
  struct Pair {
    SymmetricSix first, second;  ///< k^½ W k^½ with W = 1 + T and 1 + T⁻¹
  };
  void refresh();
  void store(std::size_t first, std::size_t count, const Symmetric3& t, const Symmetric3& inverse, Mask fit);
  using Lower = std::array<double, 21>;  ///< rows of the lower triangle of a block
  struct Power {
    Lower lower;       ///< trace 1
    double log_scale;  ///< S^(2^squarings) = e^log_scale · lower
  };
  Lower lower_triangle(Index grain) const;
  double reach(Index spring) const;
  std::vector<Power> powers(int squarings) const;

  const Sides& sides_;
  SplittingWeights weights_;
  std::vector<Index> matrix_of_;  ///< a spring: its place in the matrices, or no_index
  std::vector<Pair> pairs_;
  std::vector<SymmetricSix> before_;   ///< the matrices one sweep ago
  std::vector<Index> grains_, place_;  ///< grains of contacts with matrices; a grain's place among them
};

}  // namespace eg
