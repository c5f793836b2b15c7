#pragma once
#include "assembly/network.hpp"

namespace eg {

/// True only if λmax(M^−½KM^−½) < sigma: σ − M^−½KM^−½, lowered by what round-off can hide, has a sparse Cholesky
/// factorisation. It decides every sigma that is not within 1e-9 or so of λmax, but fill in three dimensions grows as
/// the power 4/3 of the grains and the operations as their square: for some 3·10⁴ grains at most.
bool sparse_cholesky_below(const Network& network, double sigma);

}  // namespace eg
