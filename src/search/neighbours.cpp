#include "search/neighbours.hpp"

#include <algorithm>
#include <cmath>

#include "contact/lanes.hpp"
#include "search/grid.hpp"
#include "search/hits.hpp"
#include "search/spatial_sort.hpp"
#include "search/wall_contacts.hpp"
#include "state/friction.hpp"

namespace eg {
namespace {

constexpr std::uint64_t sort_period = 32;  // builds between spatial sorts; counted in the state, so resumed runs agree

/// Straightens a cell that has been sheared far and moves every grain into it; images of listed contacts change along.
void wrap(State& state) {
  if (!state.cell.any_periodic()) return;
  const auto leaning = state.cell.straighten();
  auto& grains = state.grains;
  std::vector<std::array<std::int8_t, 3>> moved(grains.size());
  const Mat3 inv = inverse(state.cell.h);
#pragma omp parallel for if (grains.size() >= Contacts::worth_threads * Contacts::chunk)
  for (std::size_t i = 0; i < grains.size(); ++i) {
    const Vec3 s = inv * (grains.position[i].vec() - state.cell.origin);
    Vec3 back;
    for (int k = 0; k < 3; ++k) {
      if (!state.cell.periodic[static_cast<std::size_t>(k)]) continue;
      const double w = std::floor(s[k]);
      back[k] = w;
      moved[i][static_cast<std::size_t>(k)] = static_cast<std::int8_t>(std::clamp(w, -100.0, 100.0));
    }
    if (back.x != 0 || back.y != 0 || back.z != 0)
      grains.position[i].set(grains.position[i].vec() - state.cell.h * back);
  }
  auto& contacts = state.contacts;
  for (std::size_t c = 0; c < contacts.image.size(); ++c) {
    if (contacts.is_padding(c)) continue;
    auto s = Cell::renamed(Cell::steps(contacts.image[c]), leaning);
    for (std::size_t k = 0; k < 3; ++k)  // the branch stays: x_j + H s − x_i with x' = x − H w
      s[k] = std::clamp(s[k] + moved[contacts.j[c]][k] - moved[contacts.i[c]][k], -1, 1);
    contacts.image[c] = Cell::code(s[0], s[1], s[2]);
  }
}

struct Key {
  Index i, j;
  std::uint8_t image;
  friend auto operator<=>(const Key&, const Key&) = default;
};

/// Places of the contacts in the order of their keys: after wrapping and sorting of grains it is another.
void sorted_order(const Contacts& c, std::vector<Index>& order) {
  order.clear();
  for (std::size_t k = 0; k < c.size(); ++k)
    if (!c.is_padding(k)) order.push_back(static_cast<Index>(k));
  const auto key = [&](Index k) { return Key{c.i[k], c.j[k], c.image_of(k)}; };
  const auto less = [&](Index a, Index b) { return key(a) < key(b); };
  if (!std::is_sorted(order.begin(), order.end(), less)) std::sort(order.begin(), order.end(), less);
}

void fill_rows(NeighbourList& list, std::vector<NearPair>& pairs, std::size_t grains, bool periodic) {
  list.begin.assign(grains + 1, 0);
  for (const auto& p : pairs) ++list.begin[p.i + 1];
  for (std::size_t i = 0; i < grains; ++i) list.begin[i + 1] += list.begin[i];
  auto next = list.begin;
  std::vector<NearPair> sorted(pairs.size());
  for (const auto& p : pairs) sorted[next[p.i]++] = p;
#pragma omp parallel for schedule(dynamic, 1024) if (grains >= Contacts::worth_threads * Contacts::chunk)
  for (std::size_t i = 0; i < grains; ++i)
    std::sort(sorted.begin() + static_cast<std::ptrdiff_t>(list.begin[i]),
              sorted.begin() + static_cast<std::ptrdiff_t>(list.begin[i + 1]),
              [](const NearPair& a, const NearPair& b) { return a.j != b.j ? a.j < b.j : a.image < b.image; });
  list.j.resize(sorted.size());
  list.image.resize(periodic ? sorted.size() : 0);
  for (std::size_t k = 0; k < sorted.size(); ++k) {
    list.j[k] = sorted[k].j;
    if (periodic) list.image[k] = sorted[k].image;
  }
}

/// Eight pairs of the list from place p on; after its end, copies of the last one.
struct EightPairs {
  std::array<Index, Batch::lanes> j;
  std::array<std::uint8_t, Batch::lanes> image;

  EightPairs(const NeighbourList& list, std::size_t p) {
    const bool whole = p + Batch::lanes <= list.j.size(), periodic = !list.image.empty();
    image.fill(Cell::home);
    if (whole) {
      std::copy_n(&list.j[p], Batch::lanes, j.begin());
      if (periodic) std::copy_n(&list.image[p], Batch::lanes, image.begin());
    } else {
      for (std::size_t k = 0; k < Batch::lanes; ++k) {
        const std::size_t q = std::min(p + k, list.j.size() - 1);
        j[k] = list.j[q];
        if (periodic) image[k] = list.image[q];
      }
    }
  }
};

/// Pairs of a grain's row that are nearer than the skin of the contacts, in order, eight looked at at a time. `place`
/// of each pair: its number among the chunk's contacts (the first of which is `first`), before and after; no_index for
/// none.
ListScratch::Entry* find_near(const State& state, std::size_t i, const std::array<Quad, Cell::images>& shift,
                              std::size_t old_begin, std::vector<Index>& place, const ListScratch::Entry* first,
                              ListScratch::Entry* out) {
  const NeighbourList& list = state.list;
  const Quad* position = state.grains.position.data();
  const Quad a = position[i];
  const bool periodic = !list.image.empty();
  const Batch skin(a.w + list.contact_skin);
  const std::size_t end = list.begin[i + 1];
  for (std::size_t p = list.begin[i]; p < end; p += Batch::lanes) {
    const EightPairs pairs(list, p);
    Double8 rows[4];
    for (std::size_t k = 0; k < 4; ++k) {
      rows[k] = row_pair(position, pairs.j[k], pairs.j[k + 4]);
      if (periodic) rows[k] += row_pair(shift.data(), pairs.image[k], pairs.image[k + 4]);
    }
    const QuadColumns b = transpose_rows(rows);
    const Batch dx = b.x - Batch(a.x), dy = b.y - Batch(a.y), dz = b.z - Batch(a.z), reach = b.w + skin;
    const std::size_t count = std::min(Batch::lanes, end - p);
    std::array<Index, Batch::lanes> old;
    std::copy_n(&place[p], count, old.begin());
    std::fill_n(&place[p], count, no_index);
    visit_hits(dx * dx + dy * dy + dz * dz < reach * reach, count, [&](std::size_t k) {
      const Index before = old[k] == no_index ? no_index : static_cast<Index>(old_begin + old[k]);
      place[p + k] = static_cast<Index>(out - first);
      *out++ = {static_cast<Index>(i), pairs.j[k], before, pairs.image[k]};
    });
  }
  return out;
}

/// Looks up the places of a row's entries [row, end) among the contacts so far, whose order says where to go on; bonded
/// contacts that are not among them are kept, however far they have moved apart. Returns where the next entry goes.
template <class Place>
ListScratch::Entry* match_row(const Contacts& old, std::size_t i, Place& o, Place last, ListScratch::Entry* row,
                              ListScratch::Entry* end) {
  auto *next = row, *out = end;
  for (; o != last && old.i[*o] == i; ++o) {
    const auto key = Key{old.i[*o], old.j[*o], old.image_of(*o)};
    while (next != end && Key{next->i, next->j, next->image} < key) ++next;
    if (next != end && Key{next->i, next->j, next->image} == key)
      next++->old = *o;
    else if (old.is_bonded(*o))
      *out++ = {old.i[*o], old.j[*o], *o, old.image_of(*o)};
  }
  if (out != end)
    std::inplace_merge(row, end, out, [](const auto& x, const auto& y) {
      return Key{x.i, x.j, x.image} < Key{y.i, y.j, y.image};
    });
  return out;
}

/// The new contacts of a chunk's grains, in order, each with its place among the contacts so far: known from the pair's
/// (`matched`) or looked for by `order`. Returns how many.
std::size_t find_entries(const State& state, std::size_t chunk, const std::array<Quad, Cell::images>& shift,
                         bool matched, ListScratch& scratch, ListScratch::Entry* first) {
  const Contacts& old = state.contacts;
  const std::size_t low = chunk * Contacts::chunk, high = std::min(state.grains.size(), low + Contacts::chunk);
  const std::size_t old_begin = matched ? old.chunk_begin[chunk] : 0;
  auto* out = first;
  auto o = std::ranges::lower_bound(scratch.order, low, {}, [&](Index c) { return std::size_t{old.i[c]}; });
  for (std::size_t i = low; i < high; ++i) {
    auto* const row = out;
    out = find_near(state, i, shift, old_begin, scratch.place, first, out);
    if (!matched) out = match_row(old, i, o, scratch.order.end(), row, out);
  }
  return static_cast<std::size_t>(out - first);
}

/// A contact of a grain with itself in the home image.
void put_padding(Index grain, std::size_t c, Contacts& fresh) {
  fresh.i[c] = fresh.j[c] = grain;
  if (!fresh.image.empty()) fresh.image[c] = Cell::home;
  if (!fresh.friction.empty()) fresh.friction[c] = 1;
  for (std::size_t h = 0; h < fresh.history_size; ++h) fresh.history_at(c, h) = 0;
}

/// Writes entry c of the new contacts, with what is known of the pair.
void put_contact(const State& state, const ListScratch::Entry& entry, std::size_t c, Contacts& fresh) {
  const Contacts& old = state.contacts;
  fresh.i[c] = entry.i, fresh.j[c] = entry.j;
  if (!fresh.image.empty()) fresh.image[c] = entry.image;
  const bool known = entry.old != no_index;
  if (!fresh.friction.empty())
    fresh.friction[c] =
        known && !old.friction.empty()
            ? old.friction[entry.old]
            : friction_factor(state.friction_scatter, state.grains.id[entry.i], state.grains.id[entry.j]);
  if (fresh.history_size == 0) return;
  constexpr std::size_t lanes = Contacts::lanes;
  double* to = &fresh.history_at(c, 0);
  const double* from =
      known ? old.history.data() + (entry.old / lanes * old.history_size) * lanes + entry.old % lanes : nullptr;
  for (std::size_t h = 0; h < fresh.history_size; ++h) to[h * lanes] = known ? from[h * lanes] : 0.0;
}

}  // namespace

void refresh_contacts(State& state, ListScratch& scratch) {
  const NeighbourList& list = state.list;
  const Contacts& old = state.contacts;
  const std::size_t n = state.grains.size(), chunks = (n + Contacts::chunk - 1) / Contacts::chunk;
  const bool periodic = !list.image.empty();
  // Places of pairs hold as long as nobody else has touched the lists; bonded contacts may have left the list.
  const bool matched = scratch.made == std::pair{list.builds, list.refreshes} && old.bond_value == 0 &&
                       !scratch.place.empty() && scratch.place.size() == list.j.size();
  scratch.order.clear();
  if (!matched) {
    sorted_order(old, scratch.order);
    scratch.place.assign(list.j.size(), no_index);
  }
  std::array<Quad, Cell::images> shift{};
  for (std::size_t c = 0; c < Cell::images; ++c) shift[c].set(state.cell.shift(static_cast<std::uint8_t>(c)));

  const auto room = [&](std::size_t grain) {  // where entries from this grain on may begin, bonded ones included
    const std::size_t bonded =
        old.bond_value == 0
            ? 0
            : static_cast<std::size_t>(
                  std::ranges::lower_bound(scratch.order, grain, {}, [&](Index c) { return std::size_t{old.i[c]}; }) -
                  scratch.order.begin());
    return list.begin[std::min(n, grain)] + bonded + grain / Contacts::chunk;
  };
  scratch.entries.resize(room(chunks * Contacts::chunk));
  scratch.count.resize(chunks);
#pragma omp parallel for schedule(dynamic) if (chunks >= Contacts::worth_threads)
  for (std::size_t k = 0; k < chunks; ++k)
    scratch.count[k] =
        find_entries(state, k, shift, matched, scratch, scratch.entries.data() + room(k * Contacts::chunk));

  constexpr std::size_t lanes = Contacts::lanes;
  Contacts& fresh = scratch.contacts;
  fresh.history_size = old.history_size, fresh.history_vectors = old.history_vectors,
  fresh.tail_vectors = old.tail_vectors, fresh.bond_value = old.bond_value;
  fresh.chunk_begin.assign(1, 0);
  for (const std::size_t count : scratch.count)
    fresh.chunk_begin.push_back(fresh.chunk_begin.back() + (count + lanes - 1) / lanes * lanes);
  const std::size_t total = fresh.chunk_begin.back();
  fresh.i.resize(total), fresh.j.resize(total), fresh.image.resize(periodic ? total : 0);
  fresh.history.resize(total * fresh.history_size);
  fresh.friction.resize(state.friction_scatter.deviation > 0 ? total : 0);
#pragma omp parallel for schedule(dynamic) if (chunks >= Contacts::worth_threads)
  for (std::size_t k = 0; k < chunks; ++k) {
    const auto* entry = scratch.entries.data() + room(k * Contacts::chunk);
    std::size_t c = fresh.chunk_begin[k];
    for (const auto* end = entry + scratch.count[k]; entry != end; ++entry) put_contact(state, *entry, c++, fresh);
    for (; c < fresh.chunk_begin[k + 1]; ++c) put_padding(entry[-1].i, c, fresh);
  }
  std::swap(state.contacts, fresh);
  state.list.reference.resize(n);
  for (std::size_t i = 0; i < n; ++i) state.list.reference[i] = state.grains.position[i].vec();
  state.list.reference_cell = state.cell.h;
  state.list.grown = 0;
  ++state.list.refreshes;
  scratch.made = {list.builds, list.refreshes};
  refresh_wall_contacts(state);
}

void rebuild_neighbours(State& state, double skin, double contact_skin, ListScratch& scratch) {
  wrap(state);
  if (state.list.builds % sort_period == 0) sort_grains(state);
  auto pairs = find_pairs(state.grains, state.cell, skin);
  scratch.place.clear();  // the pairs go elsewhere
  auto& list = state.list;
  list.skin = skin, list.contact_skin = contact_skin;
  fill_rows(list, pairs, state.grains.size(), state.cell.any_periodic());
  list.longest = 0;
  for (const auto& p : state.grains.position) list.longest = std::max(list.longest, 2 * p.w + skin);
  refresh_contacts(state, scratch);
  list.used = 0;
  ++list.builds;
  scratch.made.first = list.builds;
}

namespace {

/// By how much two surfaces within the longest reach have come nearer beside their own travel [m].
double carried(const State& state) {
  const Mat3 strain = state.cell.h * inverse(state.list.reference_cell) - Mat3::identity();
  return norm(strain) * state.list.longest + state.list.grown;
}

}  // namespace

bool outdated(const State& state, const Travel& travel) {
  const auto& list = state.list;
  const double beside = carried(state);
  if (!(travel.approach + beside <= list.contact_skin && travel.most <= list.longest)) return true;  // or no number
  if (state.walls.empty()) return false;
  double walls = 0;
  for (const auto& w : state.walls) walls = std::max(walls, w.moved);
  return travel.most + beside + walls > wall_skin(list);
}

constexpr double widest_contact_skin = 0.22;  // of the skin: some four refreshes between rebuilds in fast flow

/// A wide skin makes the force loop take pairs that do not touch, a narrow one makes refreshes frequent.
static void fit_contact_skin(NeighbourList& list, std::uint64_t life) {
  if (life < 150) list.contact_skin = std::min(1.25 * list.contact_skin, widest_contact_skin * list.skin);
  if (life > 600) list.contact_skin = std::max(0.8 * list.contact_skin, 0.01 * list.skin);
}

/// Likewise for the pairs that refreshes look at. Grains that move fast against each other use the skin up in a few
/// steps: a wider one, as wide as the cell allows, spares more rebuilds than it costs.
static double fitted_skin(const State& state, std::uint64_t life) {
  const auto& list = state.list;
  const double usual = default_skins(state)[0];
  if (life > 300 || list.contact_skin < 0.96 * widest_contact_skin * list.skin)
    return std::max(0.8 * list.skin, std::min(list.skin, usual));
  double widest = 7 * usual;
  for (int k = 0; k < 3; ++k)
    if (state.cell.periodic[static_cast<std::size_t>(k)])
      widest = std::min(widest, 0.5 * (state.cell.width(k) - (list.longest - list.skin)));
  return std::max(list.skin, std::min(1.25 * list.skin, widest));
}

bool update_lists(State& state, const Travel& travel, ListScratch& scratch) {
  auto& list = state.list;
  if (!outdated(state, travel)) return false;
  const double used = travel.approach + carried(state);
  const std::uint64_t life = state.step - list.refreshed;
  fit_contact_skin(list, life);
  list.refreshed = state.step;
  if (list.used + used > list.skin - list.contact_skin || travel.most > list.longest) {
    rebuild_neighbours(state, fitted_skin(state, life), list.contact_skin, scratch);
  } else {
    list.used += used;
    refresh_contacts(state, scratch);
  }
  return true;
}

std::array<double, 2> default_skins(const State& state) {
  double mean = 0;
  for (const auto& p : state.grains.position) mean += p.w;
  mean /= static_cast<double>(std::max<std::size_t>(1, state.grains.size()));
  return {0.2 * mean, 0.006 * mean};
}

}  // namespace eg
