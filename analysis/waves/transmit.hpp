#pragma once
// A wave test in the time domain: one layer of a packing (or one grain) is moved by a signal, the solver of the runs
// does the rest, and the motion of every layer (or of the grains in line with the source) is kept.
#include <functional>
#include <optional>
#include <vector>

#include "state/scene.hpp"
#include "state/state.hpp"
#include "waves/signal.hpp"

namespace eg {

struct TransmitSetup {
  int axis = 2, motion = 2;  ///< along which the wave travels, and the source moves: 0, 1, 2
  Signal signal;
  double amplitude = 0;                       ///< of the source [m]
  double duration = 0;                        ///< of the test [s]
  double dt = 0;                              ///< step [s]
  int every = 1;                              ///< steps between two samples
  std::optional<Vec3> point;                  ///< the grain nearest to it is the source; else the first layer
  double damping = 0;                         ///< contact dashpots ξ, normal and tangential [-]
  std::function<void(double)> progress = {};  ///< called with the share done
};

struct Trace {
  double distance = 0;     ///< from the source [m]
  std::size_t grains = 1;  ///< in the mean
  std::vector<double> u;   ///< displacement along `motion` [m], a sample each `interval`, the first at time 0
};

struct Transmission {
  double interval = 0;        ///< between samples [s]
  std::vector<Trace> traces;  ///< by distance; the first one is the source
  double spacing = 0;         ///< of the layers [m]; 0 for a point source
  std::size_t steps = 0;
  double sliding = 0;       ///< contacts that slide at the end, over all
  bool subtracted = false;  ///< the packing was not quite at rest: its motion without source was taken away
};

/// Planes of a crystal, or slices as thick as a mean diameter of any other packing: the grains of each, from low to
/// high along the axis, and their distance.
struct Layers {
  std::vector<std::vector<Index>> grains;
  double spacing = 0;  ///< [m]
};
Layers find_layers(const State& state, int axis);

/// Works on a copy of the state, all grains starting from rest. Throws RunError when grains move so far that lists are
/// remade, InputError when there are fewer than four layers or grains in line.
Transmission transmit(const Scene& scene, const State& state, const TransmitSetup& setup);

}  // namespace eg
