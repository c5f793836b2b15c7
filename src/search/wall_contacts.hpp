#pragma once
// Which grains may meet which walls.
#include "state/state.hpp"

namespace eg {

/// Grains with a gap less than this are listed [m]. Wider than the skin of the contacts: it is used up by all motion,
/// the other only by motion of grains against each other.
inline double wall_skin(const NeighbourList& list) { return 4 * list.contact_skin; }

/// Remakes State::wall_contacts: all grains within wall_skin(), sorted by wall, then grain, with their
/// history. Throws RunError when a grain has gone through a wall (its centre lies more than its radius behind a plane
/// or cylinder without a window).
void refresh_wall_contacts(State& state);

}  // namespace eg
