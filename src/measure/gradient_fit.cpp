#include "measure/gradient_fit.hpp"

namespace eg {

std::optional<Mat3> fit_gradient(std::span<const Sample> samples, int dimension) {
  if (samples.size() <= static_cast<std::size_t>(dimension)) return std::nullopt;
  Vec3 position, value;
  double weight = 0;
  for (const auto& s : samples) position += s.weight * s.position, value += s.weight * s.value, weight += s.weight;
  position *= 1 / weight, value *= 1 / weight;
  Mat3 spread, product;
  for (const auto& s : samples) {
    spread += s.weight * outer(s.position - position, s.position - position);
    product += s.weight * outer(s.value - value, s.position - position);
  }
  if (dimension == 2) spread(2, 2) = (spread(0, 0) + spread(1, 1)) / 2;  // any number of the same size: products are 0
  const double size = trace(spread) / 3;
  if (!(determinant(spread) > 1e-12 * size * size * size)) return std::nullopt;
  return product * inverse(spread);
}

}  // namespace eg
