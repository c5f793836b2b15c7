#pragma once
// A packing in numbers: what a report or a history row says of a state.
#include "measure/contact_network.hpp"
#include "measure/force_network.hpp"
#include "measure/tensor.hpp"
#include "measure/volume.hpp"

namespace eg {

struct Homogenised {
  SizeStatistics sizes;
  double volume = 0;                ///< of the specimen [m³] (2D: [m²]), see specimen_volume()
  double solid_fraction = 0;        ///< overlaps counted twice [-]
  double void_ratio = 0;            ///< likewise
  double void_ratio_corrected = 0;  ///< overlaps counted once
  Coordination coordination;        ///< of all grains
  Coordination backbone;            ///< without rattlers
  int rattler_minimum = 2;          ///< contacts a grain of the backbone has at least: 2 with friction, D + 1 without
  Mat3 fabric, force_fabric;        ///< see fabric.hpp
  Principal fabric_axes;            ///< Φ1 ≥ Φ2 ≥ Φ3 with their directions
  Principal force_fabric_axes;
  double normal_share = 0;  ///< share of normal forces in the deviator stress; the rest is tangential forces'
  ForceNetwork forces;
  double largest_overlap = 0;  ///< over the diameter of the smaller grain [-]
  double sliding_fraction = 0;
  Mat3 stress;                                    ///< compression positive [Pa] (2D: N/m)
  double mean_stress = 0, deviator = 0;           ///< p, q
  double unbalanced_force = 0;                    ///< [-]
  double kinetic_energy = 0, elastic_energy = 0;  ///< [J]
};

/// Φ1 − Φ3 (2D: Φ1 − Φ2): how far the directions are from even.
double anisotropy(const Principal&, int dimension);

/// All of it for a state with up-to-date lists.
Homogenised homogenise(const Scene&, const State&);

}  // namespace eg
