#include "state/damping.hpp"

#include <algorithm>

namespace eg {

DampingSpec damping_in_force(const Scene& scene, const State& state) {
  DampingSpec damping = scene.damping;
  if (scene.stages.empty()) return damping;
  const StageSpec& stage = scene.stages[std::min(state.stage, scene.stages.size() - 1)];
  damping.local = stage.local_damping.value_or(damping.local);
  return damping;
}

}  // namespace eg
