#pragma once
#include <cstdint>

#include "assembly/network.hpp"

namespace eg {

struct RandomTest {
  bool below = false;  ///< λmax < sigma, unless the random vectors were drawn with bad luck
  double error = 0;    ///< probability of such bad luck, whatever the matrix
  int products = 0;    ///< with the matrix
};

/// Tests λmax(M^−½KM^−½) < sigma where every proof is too dear: a random vector grows under a Chebyshev polynomial that
/// is small on [0, lower] if an eigenvalue lies at sigma or above, unless it was nearly normal to the eigenvector
/// (after Kuczynski and Wozniakowski 1992). A probability, no proof, and labelled so wherever it is printed. lower <
/// sigma [1/s²]; about 190 products for sigma = 1.01 lower. Deterministic for a seed.
RandomTest random_test(const Network& network, double lower, double sigma, std::uint64_t seed);

}  // namespace eg
