#include "search/neighbours.hpp"

#include <algorithm>
#include <cmath>

#include "search/grid.hpp"
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

/// After wrapping, contacts of one i may be out of order by image only when one pair has several; sort all keys then.
std::vector<std::size_t> sorted_order(const Contacts& c) {
  std::vector<std::size_t> order;
  order.reserve(c.size());
  for (std::size_t k = 0; k < c.size(); ++k)
    if (!c.is_padding(k)) order.push_back(k);
  const auto key = [&](std::size_t k) { return Key{c.i[k], c.j[k], c.image_of(k)}; };
  const auto less = [&](std::size_t a, std::size_t b) { return key(a) < key(b); };
  if (!std::is_sorted(order.begin(), order.end(), less)) std::sort(order.begin(), order.end(), less);
  return order;
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

/// Contacts of one chunk, in order, with the place of their history in the old list (or none).
struct Row {
  Key key;
  std::size_t old;
};

}  // namespace

void refresh_contacts(State& state) {
  const auto& list = state.list;
  Contacts& old = state.contacts;
  const std::size_t n = state.grains.size(), chunks = (n + Contacts::chunk - 1) / Contacts::chunk;
  const bool periodic = !list.image.empty();
  const auto order = sorted_order(old);
  std::array<Vec3, Cell::images> shift;
  for (std::size_t c = 0; c < Cell::images; ++c) shift[c] = state.cell.shift(static_cast<std::uint8_t>(c));

  const auto key_of = [&](std::size_t c) { return Key{old.i[c], old.j[c], old.image_of(c)}; };
  const auto keep_bonded = [&](std::vector<Row>& to, std::size_t c) {  // however far the grains have moved apart
    if (old.is_bonded(c)) to.push_back({key_of(c), c});
  };
  std::vector<std::vector<Row>> rows(chunks);
#pragma omp parallel for schedule(dynamic) if (chunks >= Contacts::worth_threads)
  for (std::size_t k = 0; k < chunks; ++k) {
    const std::size_t low = k * Contacts::chunk, high = std::min(n, low + Contacts::chunk);
    auto o =
        std::lower_bound(order.begin(), order.end(), low, [&](std::size_t c, std::size_t g) { return old.i[c] < g; });
    for (std::size_t i = low; i < high; ++i) {
      const Quad a = state.grains.position[i];
      for (std::size_t p = list.begin[i]; p < list.begin[i + 1]; ++p) {
        const Index j = list.j[p];
        const std::uint8_t image = periodic ? list.image[p] : Cell::home;
        const Quad& b = state.grains.position[j];
        const Vec3 branch = b.vec() + shift[image] - a.vec();
        const double reach = a.w + b.w + list.contact_skin;
        if (dot(branch, branch) >= reach * reach) continue;
        const Key key{static_cast<Index>(i), j, image};
        while (o != order.end() && key_of(*o) < key) keep_bonded(rows[k], *o++);
        const bool known = o != order.end() && key_of(*o) == key;
        rows[k].push_back({key, known ? *o++ : ~std::size_t{0}});
      }
      while (o != order.end() && old.i[*o] == i) keep_bonded(rows[k], *o++);
    }
  }

  Contacts fresh;
  fresh.history_size = old.history_size, fresh.history_vectors = old.history_vectors,
  fresh.tail_vectors = old.tail_vectors, fresh.bond_value = old.bond_value;
  fresh.chunk_begin.assign(1, 0);
  constexpr std::size_t lanes = Contacts::lanes;
  for (const auto& r : rows)
    fresh.chunk_begin.push_back(fresh.chunk_begin.back() + (r.size() + lanes - 1) / lanes * lanes);
  const std::size_t total = fresh.chunk_begin.back();
  fresh.i.resize(total), fresh.j.resize(total), fresh.image.resize(periodic ? total : 0);
  fresh.history.assign(total * fresh.history_size, 0.0);
  const bool varies = state.friction_scatter.deviation > 0;
  fresh.friction.assign(varies ? total : 0, 1.0);
#pragma omp parallel for schedule(dynamic) if (chunks >= Contacts::worth_threads)
  for (std::size_t k = 0; k < chunks; ++k) {
    std::size_t c = fresh.chunk_begin[k];
    for (const auto& row : rows[k]) {
      fresh.i[c] = row.key.i, fresh.j[c] = row.key.j;
      if (periodic) fresh.image[c] = row.key.image;
      if (varies)
        fresh.friction[c] =
            row.old != ~std::size_t{0} && !old.friction.empty()
                ? old.friction[row.old]
                : friction_factor(state.friction_scatter, state.grains.id[row.key.i], state.grains.id[row.key.j]);
      if (row.old != ~std::size_t{0})
        for (std::size_t h = 0; h < fresh.history_size; ++h) fresh.history_at(c, h) = old.history_at(row.old, h);
      ++c;
    }
    for (; c < fresh.chunk_begin[k + 1]; ++c) {
      fresh.i[c] = fresh.j[c] = rows[k].back().key.i;  // padding
      if (periodic) fresh.image[c] = Cell::home;
    }
  }
  state.contacts = std::move(fresh);
  state.list.reference.resize(n);
  for (std::size_t i = 0; i < n; ++i) state.list.reference[i] = state.grains.position[i].vec();
  state.list.reference_cell = state.cell.h;
  state.list.grown = 0;
  ++state.list.refreshes;
  refresh_wall_contacts(state);
}

void rebuild_neighbours(State& state, double skin, double contact_skin) {
  wrap(state);
  if (state.list.builds % sort_period == 0) sort_grains(state);
  auto pairs = find_pairs(state.grains, state.cell, skin);
  auto& list = state.list;
  list.skin = skin, list.contact_skin = contact_skin;
  fill_rows(list, pairs, state.grains.size(), state.cell.any_periodic());
  list.longest = 0;
  for (const auto& p : state.grains.position) list.longest = std::max(list.longest, 2 * p.w + skin);
  refresh_contacts(state);
  list.used = 0;
  ++list.builds;
}

double used_skin(const State& state, double displacement) {
  const Mat3 strain = state.cell.h * inverse(state.list.reference_cell) - Mat3::identity();
  double walls = 0;
  for (const auto& w : state.walls) walls = std::max(walls, w.moved);
  return 2 * displacement + norm(strain) * state.list.longest + walls + state.list.grown;
}

/// A wide skin makes the force loop take pairs that do not touch, a narrow one makes refreshes frequent; a refresh
/// costs about three steps.
static void fit_contact_skin(NeighbourList& list, std::uint64_t life) {
  if (life < 150) list.contact_skin = std::min(1.25 * list.contact_skin, 0.25 * list.skin);
  if (life > 600) list.contact_skin = std::max(0.8 * list.contact_skin, 0.01 * list.skin);
}

bool update_lists(State& state, double displacement) {
  auto& list = state.list;
  const double used = used_skin(state, displacement);
  if (used <= list.contact_skin) return false;
  fit_contact_skin(list, state.step - list.refreshed);
  list.refreshed = state.step;
  if (list.used + used > list.skin - list.contact_skin) {
    rebuild_neighbours(state, list.skin, list.contact_skin);
  } else {
    list.used += used;
    refresh_contacts(state);
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
