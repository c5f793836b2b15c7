#pragma once
#include "state/state.hpp"

namespace eg {

/// Puts grains into the order of a space-filling curve, so that neighbours lie near each other in memory. Ids stay with
/// their grains; contacts and wall contacts are renumbered with their history (the lists must be remade afterwards).
void sort_grains(State& state);

}  // namespace eg
