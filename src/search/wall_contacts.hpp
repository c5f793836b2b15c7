#pragma once
// Which grains may meet which walls.
#include "state/state.hpp"

namespace eg {

/// Remakes State::wall_contacts: all grains within the skin of the contacts, sorted by wall, then grain, with their
/// history. Throws RunError when a grain has gone through a wall (its centre lies more than its radius behind a plane
/// or cylinder without a window).
void refresh_wall_contacts(State& state);

}  // namespace eg
