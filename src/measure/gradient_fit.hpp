#pragma once
#include <optional>
#include <span>

#include "base/vec.hpp"

namespace eg {

struct Sample {
  Vec3 position, value;
  double weight = 1;
};

/// The gradient ∂value/∂position that fits the samples best (weighted least squares, a constant set free); none when
/// they are too few or lie in one plane (2D: line). In 2D the z row and column are 0.
std::optional<Mat3> fit_gradient(std::span<const Sample> samples, int dimension);

}  // namespace eg
