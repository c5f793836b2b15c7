#pragma once
// How grains have moved between two states of one packing, and how the material around each of them has deformed.
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "measure/measure_sphere.hpp"
#include "state/state.hpp"

namespace eg {

/// The grains that two states have in common, known by their ids, in the order of the later one.
struct Displacements {
  int dimension = 3;
  std::vector<std::size_t> now;    ///< place in the later state
  std::vector<double> radius;      ///< [m]
  std::vector<Vec3> from;          ///< centre in the earlier state, wrapped into its cell [m]
  std::vector<Vec3> displacement;  ///< [m]
  Cell cell;                       ///< of the earlier state
  Mat3 gradient;                   ///< homogeneous displacement gradient of the periodic cell, 0 without one [-]

  std::size_t size() const { return from.size(); }
};

/// Along periodic directions a displacement is that of the cell's deformation (from one cell to the other by less than
/// half an edge of shear) plus less than half an edge: states farther apart than that cannot be told from nearer ones.
/// Throws InputError when the states have different dimensions or no grain in common.
Displacements displacements_between(const State& before, const State& now);

/// SmallStrain of a displacement gradient ∂u/∂x, for small strains: compression positive.
struct SmallStrain {
  Mat3 tensor;            ///< −(G + Gᵀ)/2
  double volumetric = 0;  ///< trace
  double shear = 0;       ///< ε1 − ε3 (2D: ε1 − ε2), the largest engineering shear strain
  Vec3 rotation;          ///< of the material, ½ curl u [rad]
};
SmallStrain strain_of(const Mat3& gradient, int dimension);

/// The displacement gradient around every grain: weighted least squares over the grains, images too, nearer than
/// `reach` [m] in the earlier state, weights (1 − d²/reach²)². NaN where the grains are too few.
std::vector<Mat3> local_gradients(const Displacements&, double reach);

/// Number in Displacements of the grain nearest to a place in the earlier state.
std::size_t nearest_grain(const Displacements&, const Vec3& place);

/// What happened to the grains that were inside a sphere in the earlier state; images count. Without grains all is 0.
struct SphereDisplacement {
  std::size_t grains = 0;
  Vec3 displacement;             ///< mean [m]
  std::optional<Mat3> gradient;  ///< that fits best; none when grains are too few
};
SphereDisplacement displacement_inside(const Displacements&, const MeasureSphere&);

}  // namespace eg
