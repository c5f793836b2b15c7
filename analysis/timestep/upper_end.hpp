#pragma once
#include <string>

#include "timestep/scalar_weights.hpp"

namespace eg {

struct UpperEndOptions {
  double lower = 0;     ///< λmax is not below [1/s²]
  double width = 1e-3;  ///< relative distance to `lower` that is wanted …
  double loose = 1e-2;  ///< … and the one put up with where the first would cost more than some hundred explicit steps
};

struct UpperEnd {
  double value = 0;    ///< λmax ≤ value [1/s²], round-off included
  std::string method;  ///< the certificate that gave it
};

/// The upper end of the interval for λmax(M^−½KM^−½) by the cheapest certificate that is close enough to the lower end,
/// else the best of those tried (docs/certificates.md, "The order of trying"). Deterministic.
UpperEnd find_upper_end(const Sides& sides, const ScalarWeights& weights, const UpperEndOptions& options);

}  // namespace eg
