#pragma once
// What a stage asks of the periodic cell, as linear equations for its strain rates.
#include <array>
#include <vector>

#include "state/scene.hpp"

namespace eg {

/// A value for x y z yz xz xy; 2D has x, y and xy only. Axes are positive in compression, shear is engineering shear.
using Components = std::array<double, 6>;

/// Whether a component exists in 2D or 3D.
constexpr bool component_exists(std::size_t k, int dimension) { return dimension == 3 || k <= 1 || k == 5; }

/// Σ coefficient · value over the components.
double weighted(const Components& coefficient, const Components& value);

/// Components with a rate are known; for every other one there is an equation: a stress target, or a condition of
/// `hold`. Equations on stress become equations on rates through the stiffness of an isotropic body with central
/// forces, C11 = 9/5 K, C12 = C44 = 3/5 K, in 2D 3/2 and 1/2 (Cauchy's relations). That only says which way the cell
/// must answer and by how much at once: feedback makes up for what a packing does otherwise.
class Drive {
 public:
  Drive(const StageSpec&, int dimension);

  /// The stress and rate equations, in the order of `right` below.
  const std::vector<CellCondition>& equations() const { return equations_; }
  /// Whether the equations have exactly one solution.
  bool solvable() const { return solvable_; }
  /// All strain rates [1/s] from the known ones and the right-hand sides: of a rate equation its value [1/s], of a
  /// stress equation the rate of stress over K [1/s]. Known components come back bit for bit.
  Components rates(const Components& known, const Components& right) const;

 private:
  std::vector<std::size_t> unknown_;
  std::vector<CellCondition> equations_;
  std::vector<Components> rows_;
  std::array<Components, 6> inverse_{};
  bool solvable_ = false;
};

}  // namespace eg
