#pragma once
#include <vector>

#include "state/scene.hpp"
#include "state/state.hpp"

namespace eg {

/// Works out afresh the bounds of a few grains that no longer seem to fit below state.policy.bound, with all contacts
/// at what they are allowed, and of the grains that these touch; where that is not enough, moves weights among them.
/// Whether all of them then stay below for the `time` to come [s]. Only if so does the bound change.
bool mend(const Scene& scene, State& state, const std::vector<Index>& grains, double time);

/// Whether that pays for so many of them.
bool are_few(const State& state, std::size_t grains);

/// Moves weights among the stiffest grains and all that they touch, so as to bring the largest bound down.
void ease(const Scene& scene, State& state, double time);

}  // namespace eg
