#pragma once
// A look at all listed contacts as they may be until the next check, added up grain by grain.
#include "state/schedule.hpp"
#include "timestep/grain_sums.hpp"
#include "timestep/pressed.hpp"

namespace eg {

/// What pairs are allowed, lane by lane.
struct AllowedSums {
  Batch reach = 0.0;  ///< [m]
  Batch count = 0.0;  ///< of those that are allowed anything
};

/// What a look finds, and its scratch.
struct Look {
  std::vector<Index> open;             ///< grains not proved to stay below the bound
  std::vector<std::uint8_t> outran;    ///< pairs, then walls: whether one overlaps by more than it was allowed so far
  std::size_t terms = 0;               ///< more than any of the sums below is made of
  AlignedVector<GrainSums> rows;       ///< grain after grain, then what the schedule needs: zero from look to look
  AlignedVector<Quad> grains;          ///< what weights and allowances ask of each grain
  AlignedVector<AllowedSums> allowed;  ///< of every chunk
};
/// Takes all contacts for what they may be and adds up what that means for each grain: sets overlap, weight and grain
/// of state.policy.bound. There is a bound already. `schedule`: of the lists.
void look_at_all(const Scene& scene, State& state, const PressOptions& options, const Schedule& schedule, Look& out);

}  // namespace eg
