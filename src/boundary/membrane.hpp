#pragma once
// A flexible membrane under pressure: forces on the grains that it rests on.
#include "state/scene.hpp"
#include "state/state.hpp"

namespace eg {

/// Pressure of the membrane in the stage under way [Pa] (2D: N/m); 0 without one.
double membrane_stress(const Scene& scene, const State& state);

/// Lays the membrane anew: around the specimen (outer_surface) where no plane covers it, a load σA n inwards on every
/// facet, shared among its grains by the part of the facet nearest to each (2D: halves); the share of a foot on a plane
/// goes to its grain. Sets State::membrane and State::applied. The loads stay as they are until it is laid again, so
/// they add nothing to the stiffness. Throws RunError when a grain has come through.
void lay_membrane(const Scene& scene, State& state);

/// Work of the applied forces on the grains' present velocities over a time dt [J].
double applied_work(const State& state, double dt);

}  // namespace eg
