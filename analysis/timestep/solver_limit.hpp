#pragma once
// The stability limit of the solver itself, damping and all, found by running it.
#include "state/scene.hpp"
#include "state/state.hpp"
#include "timestep/bracket.hpp"

namespace eg {

struct SolverLimitOptions {
  BracketOptions bracket;
  double perturbation = 1e-10;  ///< displacement given to the grains, over the smallest radius
  int steps = 20000;            ///< after which a step size counts as stable …
  double growth = 1e4;          ///< … and the growth of the speeds at which it counts as unstable
};

/// Brackets the largest step at which a small random perturbation of `state` does not grow, by steps of the solver with
/// the forces, the integrator and the damping of a run in the stage the state is in. Cell and walls are held still. The
/// state must be close to equilibrium: what moves already counts as perturbation. Throws std::invalid_argument unless
/// guess > 0.
StabilityBracket solver_limit(const Scene& scene, const State& state, const SolverLimitOptions& options);

}  // namespace eg
