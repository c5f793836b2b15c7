#pragma once
#include "state/scene.hpp"
#include "state/state.hpp"

namespace eg {

/// Bodies and walls of the scene's boundary; `box`: edges of the specimen [m]. With boundary type "box" its planes come
/// first, the lower and upper one of x, then of y, then of z. Throws InputError when a grain of the state lies behind a
/// wall, or a wall's material is unknown.
void make_walls(const Scene& scene, const Vec3& box, State& state);

}  // namespace eg
