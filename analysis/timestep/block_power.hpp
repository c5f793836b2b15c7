#pragma once
#include <cmath>

#include "timestep/sides.hpp"

namespace eg {

/// Powers of a positive semidefinite block by squaring, kept near 1 in size: block^(2^k) = e^log_scale · matrix.
struct BlockPower {
  Block matrix;  ///< trace 1 (0 for a zero block)
  double log_scale = 0;
  double exponent = 1;

  explicit BlockPower(const Block& block) : matrix(block) { normalise(); }

  void square() {
    matrix = (matrix * matrix).eval();
    log_scale *= 2;
    exponent *= 2;
    normalise();
  }
  /// tr(block^p)^(1/p): from above within a factor 6^(1/p) of λmax.
  double trace_root() const { return matrix.trace() > 0 ? std::exp(log_scale / exponent) : 0.0; }
  /// tr(block^(p+1)) / tr(block^p): from below, close to λmax even for small p.
  double trace_ratio(const Block& block) const { return matrix.cwiseProduct(block).sum(); }

 private:
  void normalise() {
    const double trace = matrix.trace();
    if (!(trace > 0)) return;
    matrix /= trace;
    log_scale += std::log(trace);
  }
};

}  // namespace eg
