#pragma once
// Loads that come from outside whatever grains do: a flexible membrane under pressure.
#include "base/vec.hpp"

namespace eg {

/// A force on a grain that stays as it is until it is set anew.
struct AppliedForce {
  Index grain = 0;
  Vec3 force;  ///< [N]
};

/// The membrane as it was last laid around the grains (boundary/membrane.hpp). It runs through the centres of its
/// grains.
struct Membrane {
  double stress = 0;  ///< with which it presses [Pa] (2D: N/m); 0: there is none
  double area = 0;    ///< of the part that presses on grains, without what walls cover [m²] (2D: m)
  Vec3 net;           ///< Σ f of its loads [N]
  Vec3 moment;        ///< Σ f_k x_k of its loads, axis by axis [J]
  double volume = 0;  ///< inside it and the walls that close it [m³] (2D: m²)
  double solid = 0;   ///< volume of grains inside [m³] (2D: m²)
};

}  // namespace eg
