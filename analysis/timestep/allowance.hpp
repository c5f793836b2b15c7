#pragma once
// How much a contact is allowed to grow before it is looked at again. A choice: any is sound.
#include "state/gather.hpp"

namespace eg {

/// Overlaps pressed further by the motion of the time to come, and larger by a share `slack`.
OverlapForecast with_slack(OverlapForecast f, const ContactPoint& p, double slack);
OverlapGrowth foreseen(const State& state, double time, double slack);
/// With a slack that leaves the grains of the pair below a share `up_to` of the bound, if all their contacts (of Hertz)
/// are given as much: it need not be looked at again for long. Where there is much room, a new contact may grow to what
/// is `usual` [m].
OverlapForecast with_room(const StandingBound& bound, const OverlapForecast& f, const ContactPoint& p, double slack,
                          double usual, double up_to);

/// Half of what contacts are allowed on average [m].
double usual_overlap(const StandingBound& bound);

}  // namespace eg
