#pragma once
#include "state/scene.hpp"
#include "state/state.hpp"

namespace eg {

/// The damping of the stage under way; once all stages are over, that of the last one.
DampingSpec damping_in_force(const Scene& scene, const State& state);

}  // namespace eg
