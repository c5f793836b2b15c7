#pragma once
// Who touches whom: coordination, rattlers. A grain contact has two ends, a wall contact one.
#include <cstddef>
#include <span>
#include <vector>

#include "state/gather.hpp"

namespace eg {

/// All touching contacts of a state, in the order of visit_contacts(). A state without lists has none.
std::vector<ContactPoint> touching_contacts(const Scene&, const State&);

/// Contacts that each grain has; one with an image of itself counts twice.
std::vector<int> contacts_per_grain(std::size_t grains, std::span<const ContactPoint>);

struct Coordination {
  std::size_t grains = 0, contacts = 0, wall_contacts = 0;
  std::size_t isolated = 0;  ///< grains with no contact
  std::size_t dangling = 0;  ///< grains with one contact
  double mean = 0;           ///< Z = 2 Nc/N (a wall contact counts once)
  double mechanical = 0;     ///< Z_m = (2 Nc − N1)/(N − N0 − N1) (Thornton 2000): mean over grains with 2 or more
};
/// Share of grains with one contact or none: those that Z_m leaves out [-].
double rattler_share(const Coordination&);
Coordination coordination(std::size_t grains, std::span<const ContactPoint>);

/// Grains that carry nothing: those with fewer than `minimum` contacts, taken out again and again until none is left.
/// Static equilibrium of one grain needs 2 with friction, D + 1 without.
std::vector<bool> find_rattlers(std::size_t grains, std::span<const ContactPoint>, int minimum);

/// What remains without rattlers: contacts between the others, 2 Nc/N over them.
Coordination backbone(std::size_t grains, std::span<const ContactPoint>, int minimum);

/// Contacts that slide over all contacts; 0 without contacts.
double sliding_fraction(std::span<const ContactPoint>);

/// Largest δ over the diameter of the smaller grain [-]. Above 0.05 the contact laws do not hold.
double largest_overlap(const State&, std::span<const ContactPoint>);

}  // namespace eg
