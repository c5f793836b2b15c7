#pragma once
// Neighbour search on a hierarchical grid, and the upkeep of the two lists: pairs within reach (NeighbourList, remade
// rarely) and contacts (Contacts, refreshed from them more often, keeping history).
#include <utility>

#include "search/travel.hpp"

namespace eg {

/// Memory that upkeep of the lists goes back to, so that it asks for none anew.
struct ListScratch {
  struct Entry {  ///< of the new contacts
    Index i, j;
    Index old;  ///< its place in the old ones, or no_index
    std::uint8_t image;
  };
  std::vector<Index> order;                        ///< of the old contacts
  std::vector<Index> place;                        ///< of a listed pair among its chunk's contacts, or no_index, …
  std::pair<std::uint64_t, std::uint64_t> made{};  ///< … since the list's builds and refreshes were these
  std::vector<Entry> entries;                      ///< chunk after chunk, with gaps
  std::vector<std::size_t> count;                  ///< of the entries of a chunk
  Contacts contacts;                               ///< changes places with State::contacts
};

/// Remakes both lists from positions: wraps grains into the cell, finds every pair with gap < skin, refreshes contacts.
/// Throws RunError when the cell is too narrow (a grain would meet two images of one neighbour) or a position is not
/// finite.
void rebuild_neighbours(State& state, double skin, double contact_skin, ListScratch& scratch);
inline void rebuild_neighbours(State& state, double skin, double contact_skin) {
  ListScratch scratch;
  rebuild_neighbours(state, skin, contact_skin, scratch);
}

/// Remakes contacts from the neighbour list: every pair with gap < contact_skin; history of pairs that stay is kept.
void refresh_contacts(State& state, ListScratch& scratch);
inline void refresh_contacts(State& state) {
  ListScratch scratch;
  refresh_contacts(state, scratch);
}

/// Whether, after grains have moved so far since the last refresh, a pair or a grain and a wall that State::contacts
/// and wall_contacts lack might touch. `travel` may be bounds: then so is the answer.
bool outdated(const State& state, const Travel& travel);

/// Brings the lists up to date if they are outdated. Returns whether contacts changed.
bool update_lists(State& state, const Travel& travel, ListScratch& scratch);

/// Default skins from the sizes and the number of grains: {skin, contact_skin} [m].
std::array<double, 2> default_skins(const State& state);

}  // namespace eg
