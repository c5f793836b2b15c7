#include "timestep/standing_bound.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "assembly/linearise.hpp"
#include "state/damping.hpp"
#include "timestep/mend.hpp"
#include "timestep/some_grains.hpp"

namespace eg {
namespace {

constexpr std::size_t looked_at = 64;  // stiffest grains, for a lower bound
constexpr double tight = 0.97;         // of the largest bound: grains whose bound is to be exact

bool moves(const Grains& g, Index i) { return g.velocity[i].w > 0 || (g.rotates() && g.spin[i].w > 0); }

double largest(const std::vector<double>& values) {
  return values.empty() ? 0.0 : *std::max_element(values.begin(), values.end());
}

/// Moves weights half way (in logarithm) towards centred ones.
std::vector<double> centre(const Sides& sides, const BlockRanges& ranges, double sigma, const std::vector<double>& t) {
  const Network& net = sides.network();
  const auto room = [&](Index g) { return room_below(sigma, ranges.high[g]); };
  std::vector<double> next = t;
  for (std::size_t c = 0; c < t.size(); ++c) {
    if (!sides.is_split(c)) continue;
    const Spring& s = net.springs[c];
    const auto added = [&](Index g) { return most_added(s.normal, s.tangential, inertia_of(net, g)); };
    next[c] = std::sqrt(t[c] * centred_weight(added(s.i), room(s.i), added(s.j), room(s.j)));
  }
  return next;
}

/// Centred weights leave more room for pairs to come, as long as no grain passes sigma by them.
void spread_out(const Sides& sides, double sigma, int sweeps, ScalarWeights& weights) {
  std::vector<Index> all(sides.size());
  std::iota(all.begin(), all.end(), Index{0});
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    std::vector<double> t = centre(sides, weights.ranges, sigma, weights.t);
    BlockRanges ranges(sides.size());
    block_ranges(sides, t, all, ranges);
    if (largest(ranges.high) > sigma) break;
    weights.t = std::move(t), weights.ranges = std::move(ranges);
  }
}

}  // namespace

void StandingBounds::remember(const State& state) {
  const auto& list = state.contacts;
  i_ = list.i, j_ = list.j, image_ = list.image, chunk_begin_ = list.chunk_begin, id_ = state.grains.id;
  walls_.clear();
  for (const auto& w : state.wall_contacts) walls_.push_back({w.wall, w.grain});
}

bool StandingBounds::has_lists_of(const State& state) const {
  const auto& list = state.contacts;
  const auto same = [](const WallContact& w, const std::array<Index, 2>& key) {
    return w.wall == key[0] && w.grain == key[1];
  };
  return id_ == state.grains.id && i_ == list.i && j_ == list.j && image_ == list.image &&
         std::ranges::equal(state.wall_contacts, walls_, same);
}

double StandingBounds::renew(State& state, const Schedule& schedule, const RenewOptions& options) {
  StandingBound& bound = state.policy.bound;
  bound.step = options.step;
  if (bound.value > 0 && (has_lists_of(state) || follow(state))) {
    if (options.afresh) look_at_all(scene_, state, {options.time, options.slack}, schedule, look_);
    ease(scene_, state, options.time);
  } else {
    remember(state);
    begin(state, options);
  }
  bound.value = std::max(options.floor, largest(bound.grain) * (1 + options.room));
  return known_stiffness(state) * (1 - 1e-12);
}

void StandingBounds::begin(State& state, const RenewOptions& options) {
  StandingBound& bound = state.policy.bound;
  const Pressed pressed = press_contacts(scene_, state, {options.time, options.slack});
  const Sides sides(pressed.network);
  ScalarWeights found = sweep_scalars(sides, {.most = 8});
  spread_out(sides, std::max(options.floor, largest(found.ranges.low) * (1 + options.room)), 3, found);
  for (std::size_t c = 0; c < bound.weight.size(); ++c)
    bound.weight[c] = acts(pressed.network.springs[c]) ? found.t[c] : 0.0;
  bound.grain = plays_of(sides, found.t, pressed.motion);
  const double stiff = tight * largest(found.ranges.high);
  for (Index g = 0; g < bound.grain.size(); ++g) {
    double high = found.ranges.high[g];
    if (high > stiff) high = std::min(high, block_upper_bound(scalar_block(sides, found.t, g), sides.of(g).size()));
    bound.grain[g] += high;
  }
}

double StandingBounds::known_stiffness(const State& state) const {
  const std::vector<double>& b = state.policy.bound.grain;
  const double most = largest(b);
  SomeGrains some(state);
  for (Index g = 0; g < b.size() && some.grains().size() < looked_at; ++g)
    if (b[g] > 0.9 * most) some.take_in(g);
  const std::vector<std::size_t> pairs = some.pairs(), walls = some.walls();
  const DampingSpec damping = damping_in_force(scene_, state);
  std::vector<Spring> springs;
  visit_contacts(scene_, state, {pairs, walls}, [&](const ContactPoint& p) {
    const double inverse_mass = state.grains.velocity[p.i].w + (p.j == no_index ? 0.0 : state.grains.velocity[p.j].w);
    Spring s = damped_spring(spring_of(p), inverse_mass, damping, state.policy.bound.step);
    s.i = some.take_in(p.i);
    if (p.j != no_index) s.j = some.take_in(p.j);
    springs.push_back(s);
  });
  Network net = some.network();
  net.springs = std::move(springs);
  return largest_self_block(Sides(net));
}

bool StandingBounds::follow(State& state) {
  StandingBound& bound = state.policy.bound;
  const auto& list = state.contacts;
  if (id_ != state.grains.id || bound.overlap.size() != i_.size()) return false;
  const auto pair = [](Index i, Index j) { return static_cast<std::uint64_t>(i) << 32 | j; };
  StandingBound& next = next_;
  next.overlap.resize(list.size()), next.weight.resize(list.size());
  const std::size_t chunks = list.chunk_begin.empty() ? 0 : list.chunk_begin.size() - 1;
  std::vector<std::vector<std::size_t>> fresh(chunks);
  const auto follow_chunk = [&](std::size_t k) {
    std::size_t o = chunk_begin_.empty() ? 0 : chunk_begin_[k];
    const std::size_t end = chunk_begin_.empty() ? 0 : chunk_begin_[k + 1];
    for (std::size_t c = list.chunk_begin[k]; c < list.chunk_begin[k + 1]; ++c) {
      next.overlap[c] = list.is_padding(c) ? INFINITY : 0.0, next.weight[c] = 0;
      if (list.is_padding(c)) continue;
      const std::uint64_t key = pair(list.i[c], list.j[c]);
      while (o < end && (pair(i_[o], j_[o]) < key || std::isinf(bound.overlap[o]))) ++o;
      std::size_t from = o;
      while (from < end && pair(i_[from], j_[from]) == key && !image_.empty() && image_[from] != list.image[c]) ++from;
      if (from < end && pair(i_[from], j_[from]) == key)
        next.overlap[c] = bound.overlap[from], next.weight[c] = bound.weight[from];
      else
        fresh[k].push_back(c);
    }
  };
#pragma omp parallel for schedule(static) if (chunks >= Contacts::worth_threads)
  for (std::size_t k = 0; k < chunks; ++k) follow_chunk(k);
  fresh_pairs_.clear();
  for (const auto& some : fresh) fresh_pairs_.insert(fresh_pairs_.end(), some.begin(), some.end());

  next.wall_overlap.assign(state.wall_contacts.size(), 0.0);
  fresh_walls_.clear();
  std::size_t o = 0;
  for (std::size_t c = 0; c < state.wall_contacts.size(); ++c) {
    const std::array<Index, 2> key{state.wall_contacts[c].wall, state.wall_contacts[c].grain};
    while (o < walls_.size() && walls_[o] < key) ++o;
    if (o < walls_.size() && walls_[o] == key)
      next.wall_overlap[c] = bound.wall_overlap[o];
    else
      fresh_walls_.push_back(c);
  }
  bound.overlap.swap(next.overlap), bound.weight.swap(next.weight), bound.wall_overlap.swap(next.wall_overlap);
  remember(state);
  return true;
}

void StandingBounds::add_fresh(State& state, const CountedContact& contact, std::vector<Index>& open) const {
  const auto& g = state.grains;
  StandingBound& bound = state.policy.bound;
  const Counted& k = contact.counted;
  const auto add = [&](Index i, double w) {
    const Inertia inertia = inertia_of(g, i);
    bound.grain[i] +=
        (w * (most_added(k.normal, k.tangential, inertia) + play(k.normal, k.tangential, contact.motion, inertia)) +
         std::max(k.twisting, k.rolling) * inertia.inverse_inertia +
         play_of_couple(k.twisting, k.rolling, contact.motion, inertia)) *
        sum_rounding;
    if (!(bound.grain[i] <= bound.value)) open.push_back(i);
  };
  if (contact.j == no_index) return add(contact.i, 1);
  const bool split = moves(g, contact.i) && moves(g, contact.j);
  const auto room = [&](Index i) { return room_below(bound.value, bound.grain[i]); };
  const double t =
      split ? centred_weight(g.velocity[contact.i].w, room(contact.i), g.velocity[contact.j].w, room(contact.j)) : 1.0;
  bound.weight[contact.entry] = t;
  add(contact.i, split ? 1 + t : 1), add(contact.j, split ? 1 + 1 / t : 1);
}

bool StandingBounds::mend_few(State& state, std::vector<Index>& grains, double time) const {
  if (grains.empty()) return true;
  std::ranges::sort(grains);
  grains.erase(std::unique(grains.begin(), grains.end()), grains.end());
  return are_few(state, grains.size()) && mend(scene_, state, grains, time);
}

StandingCheck StandingBounds::check(State& state, const Schedule& schedule, double time, double slack) {
  look_at_all(scene_, state, {time, slack}, schedule, look_);
  StandingCheck result;
  result.mended = look_.open.size();
  result.stands = mend_few(state, look_.open, time);
  if (!result.stands) result.outrun = has_outrun(state, look_.open);
  return result;
}

bool StandingBounds::check_fresh(State& state, double time, double slack) {
  const ContactSelection fresh{fresh_pairs_, fresh_walls_};
  allow(scene_, state, fresh, {time, slack});
  std::vector<Index> open;
  for (const CountedContact& contact : counted_contacts(scene_, state, fresh, time)) add_fresh(state, contact, open);
  return mend_few(state, open, time);
}

bool StandingBounds::has_outrun(const State& state, const std::vector<Index>& grains) const {
  SomeGrains some(state);
  for (const Index g : grains) some.take_in(g);
  const auto out = [&](std::size_t place) { return look_.outran[place] != 0; };
  return std::ranges::any_of(some.pairs(), out) ||
         std::ranges::any_of(some.walls(), [&](std::size_t w) { return out(state.contacts.size() + w); });
}

}  // namespace eg
