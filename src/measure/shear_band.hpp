#pragma once
// The zone of concentrated shear in a field of displacements.
#include <optional>
#include <span>

#include "base/vec.hpp"

namespace eg {

/// Two bodies that move past each other, with a layer of even strain between them:
///   u(x) = a + G·x + jump · ramp((n·x − position)/thickness), ramp from −½ to ½ over the layer.
struct ShearBand {
  Vec3 normal;           ///< n, unit; its first component that is not 0 is positive
  double position = 0;   ///< n·x in the middle of the band [m]
  double thickness = 0;  ///< [m]
  Vec3 jump;             ///< displacement of the side that n points to against the other, beyond G·x [m]
  double explained = 0;  ///< share of Σ|u − a − G·x|², fitted without a band, that the band takes away [0, 1]

  double opening() const { return dot(jump, normal); }  ///< [m]
  double slip() const { return norm(jump - opening() * normal); }
};

/// The band that leaves the least squares of displacements [m] at points [m]: directions and places are scanned, then
/// refined. It is at most half as thick as the points spread along its normal. With several bands it finds the one that
/// explains most. None with fewer than 20 points.
std::optional<ShearBand> find_shear_band(std::span<const Vec3> points, std::span<const Vec3> displacements,
                                         int dimension);

}  // namespace eg
