#pragma once
// Neighbour search on a hierarchical grid, and the upkeep of the two lists: pairs within reach (NeighbourList, remade
// rarely) and contacts (Contacts, refreshed from them more often, keeping history).
#include "state/state.hpp"

namespace eg {

/// Remakes both lists from positions: wraps grains into the cell, finds every pair with gap < skin, refreshes contacts.
/// Throws RunError when the cell is too narrow (a grain would meet two images of one neighbour) or a position is not
/// finite.
void rebuild_neighbours(State& state, double skin, double contact_skin);

/// Remakes contacts from the neighbour list: every pair with gap < contact_skin; history of pairs that stay is kept.
void refresh_contacts(State& state);

/// The part of the skin used up since the last refresh [m], growth of radii included, given the largest peculiar
/// displacement of a grain since then: twice that, plus the cell's strain over the longest reach, plus the motion of
/// walls. No pair has come nearer by more.
double used_skin(const State& state, double displacement);

/// Brings the lists up to date if some pair that State::contacts lacks might touch. Returns whether contacts changed.
bool update_lists(State& state, double displacement);

/// Default skins from the sizes and the number of grains: {skin, contact_skin} [m].
std::array<double, 2> default_skins(const State& state);

}  // namespace eg
