#pragma once
// Block-Jacobi preconditioner of K that takes grains held by each other more than by the rest as one block.
//
// Slow modes of D⁻¹K (D: the blocks of single grains) are local: pairs and triples of grains with two or three
// contacts, nearly in line, that move together almost freely. The more grains, the more extreme the worst of them, and
// conjugate gradients stall until they have found each. Such grains are joined: those with σ > 0.8, σ the largest
// singular value of D_i^−½ K_ij D_j^−½, for the scaled stiffness of the pair has the least eigenvalue 1 − σ.
#include <Eigen/Core>
#include <span>
#include <vector>

#include "assembly/network.hpp"
#include "eigen/block_jacobi.hpp"

namespace eg {

class ClusterJacobi {
 public:
  explicit ClusterJacobi(const Network& network);

  std::size_t rows() const { return grains_.rows(); }
  /// z = D⁻¹ r, D the blocks of clusters; zero blocks count as 1.
  void apply(std::span<const double> r, std::span<double> z) const;

  /// Clusters of two grains and more, each a list of grains.
  const std::vector<std::vector<Index>>& clusters() const { return clusters_; }

 private:
  BlockJacobi grains_;
  std::vector<std::vector<Index>> clusters_;
  std::vector<Eigen::MatrixXd> inverse_;  ///< of each cluster's block
};

}  // namespace eg
