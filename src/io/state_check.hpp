#pragma once
#include <string>

#include "state/scene.hpp"
#include "state/state.hpp"

namespace eg {

/// Throws InputError "file: subject rule; remedy" for a state that no run can have left: arrays of different lengths,
/// numbers of grains, walls or materials that do not exist, radii ≤ 0, NaN. Private to io.
void check_state(const Scene&, const State&, const std::string& file);

}  // namespace eg
