#pragma once
// Packings whose contacts do not slip.
#include <algorithm>

#include "state/state.hpp"

namespace eg::test {

/// Friction that no contact comes near, until the next stage begins: K of the springs is then that of the motion. A
/// contact at Coulomb's limit gives way instead, and where it holds a grain of the stiffest mode it lets runs stay
/// stable at steps up to 1 % above the limit of the springs.
inline void hold_all_contacts(State& state) { std::ranges::fill(state.friction, 1e3); }

}  // namespace eg::test
