#pragma once
// How unevenly forces are carried.
#include <span>

#include "state/gather.hpp"

namespace eg {

/// The strong network: contacts whose normal force is above the mean (Radjai et al. 1998).
struct ForceNetwork {
  double mean_force = 0;             ///< ⟨N⟩ over all contacts, walls included [N]
  double largest_force = 0;          ///< [N]
  double strong_contacts = 0;        ///< share of contacts [-]
  double strong_mean_share = 0;      ///< share of the mean stress that they carry [-]
  double strong_deviator_share = 0;  ///< share of the deviator stress, deviator_share() [-]
  double mobilised_friction = 0;     ///< mean of |T|/(µN) over contacts with µN > 0 [-]
};
ForceNetwork force_network(std::span<const ContactPoint>, int dimension);

inline bool is_strong(const ContactPoint& c, double mean_force) { return c.normal.force > mean_force; }

}  // namespace eg
