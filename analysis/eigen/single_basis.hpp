#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace eg::detail {

/// Vectors kept in single precision, until they would take more than `bytes`: then all are dropped.
class SingleBasis {
 public:
  explicit SingleBasis(std::size_t bytes) : room_(bytes / sizeof(float)) {}

  void push(std::span<const double> v);
  bool complete() const { return room_ > 0; }
  /// Σ weights_k v_k
  std::vector<double> combine(std::span<const double> weights) const;

 private:
  std::size_t room_;  ///< numbers in all; 0: given up
  std::vector<std::vector<float>> vectors_;
};

}  // namespace eg::detail
