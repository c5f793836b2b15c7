#pragma once
// Moduli found by running the packing itself: tiny strain steps forth and back, each relaxed with viscous damping.
// Knows nothing of K, so that both ways can be held against each other.
#include <Eigen/Core>
#include <functional>
#include <vector>

#include "state/scene.hpp"
#include "state/state.hpp"

namespace eg {

struct ProbeOptions {
  double step = 0;                            ///< stable time step [s], e.g. 0.8 of the proved one
  double strain = 1e-6;                       ///< tried first; then smaller or larger by decades
  double agreement = 1e-3;                    ///< moduli of two strains that count as the same
  double end_of_linear = 0.01;                ///< change of the moduli beyond which a strain is no longer linear
  std::function<void(double)> progress = {};  ///< called with the share of the work done, 0…1
};

struct ProbedModuli {
  Eigen::MatrixXd voigt;       ///< C_ab: stress a for strain b [Pa]; as found, not made symmetric
  std::vector<double> strain;  ///< of each load, the smaller of two whose moduli agree
  std::vector<double> linear;  ///< largest strain tried up to which the moduli stay within `end_of_linear`
  std::int64_t steps = 0;      ///< taken in all
  bool found = true;           ///< false: no two strains agreed, or a relaxation did not end
};

/// Strains a periodic cell at rest by ±ε, one of Voigt's components after the other, and takes the difference of the
/// stresses once it has stopped changing: what the packing would do by itself (creep, drift) falls out. Friction,
/// contact changes and history act as in any run. Throws std::invalid_argument unless step > 0.
ProbedModuli probe(const Scene& scene, const State& state, const ProbeOptions& options);

}  // namespace eg
