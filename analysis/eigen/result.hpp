#pragma once
#include <string>
#include <vector>

namespace eg {

/// One eigenpair of a symmetric operator.
struct EigenResult {
  double value = 0;            ///< θ = xᵀAx: for the largest eigenvalue a lower bound of it, up to round-off
  double residual = 0;         ///< ‖Ax − θx‖, computed, x of length 1: some eigenvalue lies within it of θ
  std::vector<double> vector;  ///< x, ‖x‖ = 1
  int products = 0;            ///< how often the operator was applied
  bool converged = false;      ///< residual within the tolerance asked for
  std::string method;
};

}  // namespace eg
