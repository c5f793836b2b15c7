#pragma once
// Stages that change the grains to bring a specimen to a density: friction that falls, radii that grow.
#include "dynamics/engine.hpp"

namespace eg {

/// A stage begins: its growth rate is in force from now on, grains above its held_above stand still (they are given
/// the inverse mass 0) and those that stood in the stage before are let go.
void begin_preparation(const Scene&, State&);

/// What acts on grains at this time of the stage: gravity, and the shaking of the apparatus [m/s²].
Vec3 gravity_in_force(const Scene&, const State&);

/// To be called after every tenth step.
///
/// Friction schedule: once the packing has come to rest (`at_rest`) at the friction that the stage begins with, that
/// friction is lowered by a tenth whenever it is at rest, below 1e-3 to 0. As soon as the target is met it is put back,
/// so that all contacts stick and the packing stays as it is. Throws RunError when the packing at rest is below the
/// target from the beginning, or above it without any friction.
///
/// Growth: radii go with exp(rate · time) until they have the sizes of the grading.
void prepare_grains(const StageSpec&, State&, Engine&, bool at_rest);

/// Whether the stage has nothing left to do to its grains.
bool is_prepared(const StageSpec&, const State&);

}  // namespace eg
