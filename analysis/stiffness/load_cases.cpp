#include "stiffness/load_cases.hpp"

#include <cmath>

#include "stiffness/elastic_tensor.hpp"

namespace eg {

LoadCases periodic_strains(int dimension) {
  LoadCases cases;
  for (int a = 0; a < (dimension == 3 ? 6 : 3); ++a) cases.names.emplace_back(voigt_name(dimension, a));
  cases.jump = [dimension](const Spring& s, int a) {
    const auto [i, j] = voigt_component(dimension, a);
    Vec3 e;
    if (i == j) {
      e[i] = s.length * s.n[i];
    } else {
      e[i] = 0.5 * s.length * s.n[j];
      e[j] = 0.5 * s.length * s.n[i];
    }
    return e;
  };
  return cases;
}

LoadCases platen_strains(const std::array<double, 3>& distance) {
  LoadCases cases;
  std::vector<int> axes;
  for (int k = 0; k < 3; ++k)
    if (distance[static_cast<std::size_t>(k)] > 0) axes.push_back(k), cases.names.emplace_back(voigt_name(3, k));
  cases.jump = [axes, distance](const Spring& s, int a) {
    const int k = axes[static_cast<std::size_t>(a)];
    const bool on_platen = s.j == no_index && s.arm_j == 0 && std::abs(s.n[k]) > 1 - 1e-9;
    Vec3 e;
    if (on_platen) e[k] = std::copysign(0.5 * distance[static_cast<std::size_t>(k)], s.n[k]);
    return e;
  };
  return cases;
}

}  // namespace eg
