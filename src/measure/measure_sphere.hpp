#pragma once
// A sphere (2D: a circle) laid into a packing, and what holds inside it. Periodic images are part of the packing.
#include <optional>
#include <span>

#include "state/gather.hpp"

namespace eg {

struct MeasureSphere {
  Vec3 centre;        ///< [m]; 2D: z = 0
  double radius = 0;  ///< [m], > 0
};

struct SphereMeasures {
  double volume = 0;  ///< of the sphere [m³] (2D: [m²])
  /// Volume of grains inside over the volume, by exact sphere–sphere lenses; overlaps of grains count twice [-].
  double solid_fraction = 0;
  double void_ratio = 0;    ///< 1/solid_fraction − 1 [-]; infinite when nothing is inside
  std::size_t grains = 0;   ///< with their centre inside
  double coordination = 0;  ///< mean number of contacts of these grains
  /// σ = (1/V) Σ f⊗l w over contacts, w the share of the branch inside (Hardy 1982 with a window of constant weight)
  /// [Pa]: a sphere that holds all has the stress of all, and windows that fill space share the whole among them.
  Mat3 stress;
  /// Velocity gradient that fits the velocities of the grains inside best, Σ|v − v̄ − L(x − x̄)|² least [1/s], tension
  /// positive; nothing for grains too few or in one plane (2D: line). Velocities are those of the last half step.
  std::optional<Mat3> velocity_gradient;
};

/// `contacts`: all of the state, touching_contacts().
SphereMeasures measure_sphere(const State&, std::span<const ContactPoint> contacts, const MeasureSphere&);

/// Share of the segment from a to b that lies inside the sphere, 0 … 1.
double share_inside(const Vec3& a, const Vec3& b, const MeasureSphere&);

}  // namespace eg
