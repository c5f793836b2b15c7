#pragma once
#include "timestep/interval.hpp"
#include "timestep/scalar_weights.hpp"

namespace eg {

/// λmax from below and its mode: Lanczos on the grains that cannot be proved to lie below it one by one, with three
/// shells of neighbours and all others held fixed, or on all when those are not few. Fills lambda_lower, method_lower,
/// residual, products and mode.
void find_lower_end(const Sides& sides, const ScalarWeights& weights, const IntervalOptions& options,
                    StepInterval& interval);

}  // namespace eg
