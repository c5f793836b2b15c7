#pragma once
// Scalar weights of contact splitting: the part of the bound that is cheap enough for every few hundred steps of a run.
#include <span>
#include <vector>

#include "timestep/block_ranges.hpp"

namespace eg {

struct ScalarWeights {
  std::vector<double> t;  ///< one a spring, > 0
  BlockRanges ranges;     ///< of S_i with these weights
  double known = 0;       ///< λmax is not below: the largest eigenvalue of a self block [1/s²]; 0 after a warm start
  int sweeps = 0;
};

struct ScalarSweepOptions {
  int most = 30;                       ///< sweeps; they end earlier when the bound stands still …
  double target = 0;                   ///< … or has come down to this [1/s²]
  std::span<const double> start = {};  ///< weights to begin with, one a spring; empty: 1
};

/// The largest eigenvalue of a self block Σ AᵀA [1/s²], a few per cent low at most: λmax(M⁻¹K) is not below.
double largest_self_block(const Sides& sides);

/// Improves t = 1 by sweeps t ← t λmax(S_j)/λmax(S_i), which even out the two grains of a contact. The first goes over
/// all contacts; later ones leave out the contacts between grains already proved to be below a known lower bound of
/// λmax. A warm start sweeps only over what lies near the maximum. A pure function of the network; the same for any
/// number of threads.
ScalarWeights sweep_scalars(const Sides& sides, const ScalarSweepOptions& options);

}  // namespace eg
