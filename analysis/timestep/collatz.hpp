#pragma once
#include "timestep/sides.hpp"

namespace eg {

struct CollatzBound {
  double value = 0;        ///< λmax ≤ value [1/s²], round-off included
  Index grain = no_index;  ///< the grain that decides it
  int sweeps = 0;
};

/// Upper bound of λmax(M⁻¹K) by block Collatz–Wielandt: with N_ij ≥ ‖M_i^−½K_ij M_j^−½‖₂ and any y > 0,
/// λmax ≤ ρ(N) ≤ max_i (Ny)_i / y_i; `sweeps` power steps choose y. Only block norms are used, so it would hold for a
/// nonsymmetric K too (Varga 2000, section 2.1).
CollatzBound collatz_bound(const Network& network, int sweeps = 40);

}  // namespace eg
