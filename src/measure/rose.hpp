#pragma once
// Rose diagrams: how many contacts point which way, and how hard they press. Every contact counts with n and −n, so a
// rose is the same seen from behind; contacts with walls are left out.
#include <span>
#include <vector>

#include "state/gather.hpp"

namespace eg {

/// One direction of a rose: a sector (2D), or a patch of the unit sphere (3D).
struct Petal {
  double azimuth_from = 0, azimuth_to = 0;  ///< from x towards y [rad]
  double height_from = 0, height_to = 0;    ///< z of the unit sphere (2D: both 0)
  /// Share of contacts over the share of all directions: 1 everywhere when contacts are isotropic.
  double density = 0;
  /// Mean normal force over that of all contacts; 0 where there are none.
  double force = 0;
};

/// 2D: `sectors` equal angles, the first one around x. Even, so that n and −n are alike.
std::vector<Petal> rose_2d(std::span<const ContactPoint>, int sectors = 36);

/// 3D: patches of equal area, `rings` of equal height times 2 `rings` azimuths.
std::vector<Petal> rose_3d(std::span<const ContactPoint>, int rings = 8);

}  // namespace eg
