#pragma once
// The nearest tensors of higher symmetry: orthogonal projections in the Frobenius norm of the tensor (Moakher and
// Norris 2006), which a mean over the group of rotations is.
#include "stiffness/elastic_tensor.hpp"

namespace eg {

struct IsotropicFit {
  double bulk = 0, shear = 0;     ///< K, G [Pa]; 2D: of the plane [N/m]
  double young = 0, poisson = 0;  ///< E [Pa], ν [-]
  double misfit = 0;              ///< ‖C − fit‖/‖C‖
};
IsotropicFit isotropic_fit(const ElasticTensor& tensor);

/// 3D only. Constants in axes with 3 along `axis` [Pa].
struct TransverseFit {
  Vec3 axis;  ///< unit, z ≥ 0
  double c11 = 0, c33 = 0, c13 = 0, c44 = 0, c66 = 0;
  double misfit = 0;  ///< ‖C − fit‖/‖C‖
};
TransverseFit transverse_fit(const ElasticTensor& tensor, const Vec3& axis);
/// With the axis that fits best, found on a grid over the half sphere and refined to 1e-6 rad.
TransverseFit transverse_fit(const ElasticTensor& tensor);

}  // namespace eg
