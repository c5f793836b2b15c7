#pragma once
#include "state/packing.hpp"
#include "state/scene.hpp"
#include "state/state.hpp"

namespace eg {

/// Grains of the scene's first material at rest where the packing has them, numbered from 1 in its order; no contacts
/// yet. A scene with a trim takes what that leaves (specimen/trim.hpp). The scene's boundary decides what becomes of
/// the box: a periodic cell (centres are wrapped into it), walls (the lower and upper one of x, then of y, then of z,
/// before those of [[boundary.wall]]), or nothing but a size. Throws InputError when packing and scene do not go
/// together or the box is too narrow.
State make_state(const Scene&, const Packing&);

/// Gives grains spins (at rest) or takes them away, as the scene needs them: where rotation is off, or no contact can
/// turn a grain (no friction anywhere, no couples), spins and inertia are not stored at all.
void fit_rotation(const Scene& scene, State& state);

}  // namespace eg
