#include "timestep/standing_bound.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "assembly/linearise.hpp"
#include "state/damping.hpp"
#include "timestep/mend.hpp"
#include "timestep/outgrown.hpp"

namespace eg {
namespace {

constexpr double straight = 2;         // no two unit vectors are further apart
constexpr std::size_t few = 16;        // one in so many contacts beyond what it is allowed: taken one by one
constexpr std::size_t patched = 64;    // one in so many grains that do not fit, or 16: mended by themselves
constexpr std::size_t looked_at = 64;  // stiffest grains, for a lower bound
constexpr double tight = 0.97;         // of the bound: from here on weights are improved in a check

bool moves(const Grains& g, Index i) { return g.velocity[i].w > 0 || (g.rotates() && g.spin[i].w > 0); }

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

double largest(const std::vector<double>& values) {
  return values.empty() ? 0.0 : *std::max_element(values.begin(), values.end());
}

std::vector<Index> all_grains(const Sides& sides) {
  std::vector<Index> all(sides.size());
  std::iota(all.begin(), all.end(), Index{0});
  return all;
}

/// Centred weights leave more room for pairs to come, as long as no grain passes sigma by them.
void spread_out(const Sides& sides, double sigma, int sweeps, ScalarWeights& weights) {
  const std::vector<Index> all = all_grains(sides);
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    std::vector<double> t = centre(sides, weights.ranges, sigma, weights.t);
    BlockRanges ranges(sides.size());
    block_ranges(sides, t, all, ranges);
    if (largest(ranges.high) > sigma) break;
    weights.t = std::move(t), weights.ranges = std::move(ranges);
  }
}

/// t of a pair: the one it has, else the one that the room of its grains suggests.
double weight_of(const State& state, const Beyond& pair) {
  const StandingBound& bound = state.policy.bound;
  if (bound.weight[pair.entry] > 0) return bound.weight[pair.entry];
  const auto& velocity = state.grains.velocity;  // w: inverse mass
  const auto room = [&](Index g) { return room_below(bound.value, bound.grain[g]); };
  return centred_weight(velocity[pair.i].w, room(pair.i), velocity[pair.j].w, room(pair.j));
}

void keep_grains(const BlockRanges& ranges, const std::vector<GrainPlay>& plays, StandingBound& bound) {
  bound.grain.resize(plays.size()), bound.turning.resize(plays.size());
  for (std::size_t g = 0; g < plays.size(); ++g) keep_grain(bound, g, ranges.high[g], plays[g]);
}

/// By how much all directions of a grain's contacts may be off.
double turn_room(const StandingBound& bound, std::size_t i) {
  const double room = std::max(0.0, bound.value - bound.grain[i]);
  return room < bound.turning[i] * straight ? room / bound.turning[i] : straight;
}

/// Shares of that of every grain.
void take_turn_room(const StandingBound& bound, double share, std::vector<double>& out) {
  out.resize(bound.grain.size());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = share * turn_room(bound, i);
}

/// No λmax(S_i) is above.
double largest_block(const Sides& sides, const std::vector<double>& t, const BlockRanges& ranges) {
  double most = largest(ranges.low);
  for (Index g = 0; g < sides.size(); ++g)
    if (ranges.high[g] > most)
      most = std::max(most, std::min(ranges.high[g], block_upper_bound(scalar_block(sides, t, g), sides.of(g).size())));
  return most;
}

}  // namespace

void StandingBounds::remember(const State& state) {
  const auto& list = state.contacts;
  i_ = list.i, j_ = list.j, image_ = list.image, id_ = state.grains.id;
  walls_.clear();
  for (const auto& w : state.wall_contacts) walls_.push_back({w.wall, w.grain});
  sides_.reset(), look_.scheduled = false;
}

bool StandingBounds::has_lists_of(const State& state) const {
  const auto& list = state.contacts;
  const auto same = [](const WallContact& w, const std::array<Index, 2>& key) {
    return w.wall == key[0] && w.grain == key[1];
  };
  return id_ == state.grains.id && i_ == list.i && j_ == list.j && image_ == list.image &&
         std::ranges::equal(state.wall_contacts, walls_, same);
}

void StandingBounds::press(State& state, const PressOptions& options) {
  if (!sides_) {
    lay_out(scene_, state, pressed_);
    sides_.emplace(pressed_.network);
  }
  press_contacts(scene_, state, options, pressed_);
  weights_.reset();
}

void StandingBounds::keep(StandingBound& bound, const ScalarWeights& weights,
                          const std::vector<GrainPlay>& plays) const {
  for (std::size_t c = 0; c < bound.weight.size(); ++c)
    bound.weight[c] = acts(pressed_.network.springs[c]) ? weights.t[c] : 0.0;
  keep_grains(weights.ranges, plays, bound);
}

std::vector<Index> StandingBounds::beyond(const StandingBound& bound, const ScalarWeights& found,
                                          const std::vector<GrainPlay>& plays) const {
  std::vector<Index> grains;
  for (Index g = 0; g < plays.size(); ++g) {
    const double most = most_below(bound.value, plays[g]);
    if (!(found.ranges.high[g] < most) &&
        !block_is_below(scalar_block(*sides_, found.t, g), sides_->of(g).size(), most))
      grains.push_back(g);
  }
  return grains;
}

bool StandingBounds::fits(State& state, double time, double slack) {
  StandingBound& bound = state.policy.bound;
  if (!look_.scheduled) lay_out(state, look_);
  weights_.reset();
  look_at_all(scene_, state, {time, slack}, look_);
  bound_grains(state, look_.rows, look_.terms, look_.ranges, look_.plays);
  std::vector<Index> open;
  for (Index g = 0; g < look_.plays.size(); ++g) {
    const double most = most_below(bound.value, look_.plays[g]);
    if (!(look_.ranges.high[g] < most) && !block_is_below(block_of(state, g, look_.rows[g]), look_.terms, most))
      open.push_back(g);
  }
  keep_grains(look_.ranges, look_.plays, bound);
  bound.weight = look_.weight;
  return mend_few(state, open, time) || fits_by_sweeps(state, time, slack);
}

bool StandingBounds::fits_by_sweeps(State& state, double time, double slack) {
  StandingBound& bound = state.policy.bound;
  press(state, {time, slack, look_.weight});
  ScalarWeights found = sweep_scalars(*sides_, {.most = 4, .target = tight * bound.value, .start = pressed_.weight});
  const std::vector<GrainPlay> plays = plays_of(*sides_, found.t, pressed_.motion);
  const std::vector<Index> grains = beyond(bound, found, plays);
  if (grains.empty()) {
    keep(bound, found, plays);
    return true;
  }
  for (const Index g : grains)
    for (const Side& side : sides_->of(g))
      outrun_ = outrun_ || (side.spring < look_.outran.size() && look_.outran[side.spring]);
  weights_ = std::move(found);
  return false;
}

double StandingBounds::renew(State& state, const RenewOptions& options) {
  StandingBound& bound = state.policy.bound;
  bound.step = options.step;
  const bool warm = bound.value > 0 && (has_lists_of(state) || follow(state));
  if (!warm) remember(state), bound.value = 0;
  if (options.afresh || !weights_) press(state, {options.time, options.slack});
  ScalarWeights found = weights_ ? std::move(*weights_)
                        : warm   ? sweep_scalars(*sides_, {.most = 4, .start = pressed_.weight})
                                 : sweep_scalars(*sides_, {.most = 8});
  weights_.reset();
  const double sigma = std::max(options.floor, largest(found.ranges.low) * (1 + options.room));
  if (!warm) spread_out(*sides_, sigma, 3, found);
  const double needed = largest_block(*sides_, found.t, found.ranges);
  for (double& high : found.ranges.high) high = std::min(high, needed);
  const std::vector<GrainPlay> plays = plays_of(*sides_, found.t, pressed_.motion);
  double most = 0;
  for (Index g = 0; g < plays.size(); ++g)
    most = std::max(most, found.ranges.high[g] + std::max(plays[g].counted, plays[g].ahead));
  bound.value = std::max(sigma, most * (1 + 0.2 * options.room));
  bound.weight.resize(state.contacts.size());
  keep(bound, found, plays);

  std::vector<Index> stiffest;
  for (Index g = 0; g < plays.size() && stiffest.size() < looked_at; ++g)
    if (found.ranges.low[g] > 0.9 * needed) stiffest.push_back(g);
  return largest_self_block(Sides(around(state, stiffest))) * (1 - 1e-12);
}

Network StandingBounds::around(const State& state, const std::vector<Index>& grains) const {
  const std::size_t pairs = state.contacts.size(), contacts = pairs + state.wall_contacts.size();
  std::vector<std::size_t> entries, wall_entries;
  for (const Index g : grains)
    for (const Side& side : sides_->of(g))
      if (side.spring < pairs)
        entries.push_back(side.spring);
      else if (side.spring < contacts)
        wall_entries.push_back(side.spring - pairs);
  for (auto* list : {&entries, &wall_entries}) {
    std::ranges::sort(*list);
    list->erase(std::unique(list->begin(), list->end()), list->end());
  }
  Network net = bare_network(scene_, state);
  const DampingSpec damping = damping_in_force(scene_, state);
  visit_contacts(scene_, state, {entries, wall_entries}, [&](const ContactPoint& p) {
    const double inverse_mass = net.inverse_mass[p.i] + (p.j == no_index ? 0.0 : net.inverse_mass[p.j]);
    net.springs.push_back(damped_spring(spring_of(p), inverse_mass, damping, state.policy.bound.step));
  });
  return net;
}

bool StandingBounds::follow(State& state) {
  StandingBound& bound = state.policy.bound;
  const auto& list = state.contacts;
  if (id_ != state.grains.id || bound.overlap.size() != i_.size()) return false;
  const auto pair = [](Index i, Index j) { return static_cast<std::uint64_t>(i) << 32 | j; };
  StandingBound& next = next_;
  next.overlap.assign(list.size(), 0.0), next.weight.assign(list.size(), 0.0);
  next.direction.assign(3 * list.size(), 0.0F);
  fresh_.clear();
  std::size_t o = 0;
  for (std::size_t c = 0; c < list.size(); ++c) {
    if (list.is_padding(c)) {
      next.overlap[c] = INFINITY;
      continue;
    }
    const std::uint64_t key = pair(list.i[c], list.j[c]);
    while (o < i_.size() && (pair(i_[o], j_[o]) < key || std::isinf(bound.overlap[o]))) ++o;
    std::size_t from = o;
    while (from < i_.size() && pair(i_[from], j_[from]) == key && !image_.empty() && image_[from] != list.image[c])
      ++from;
    if (from < i_.size() && pair(i_[from], j_[from]) == key) {
      next.overlap[c] = bound.overlap[from], next.weight[c] = bound.weight[from];
      set_direction(next, c, counted_direction(bound, from));
    } else {
      fresh_.push_back(c);
    }
  }
  next.wall_overlap.assign(state.wall_contacts.size(), 0.0),
      next.wall_direction.assign(state.wall_contacts.size(), Vec3{});
  o = 0;
  for (std::size_t c = 0; c < state.wall_contacts.size(); ++c) {
    const std::array<Index, 2> key{state.wall_contacts[c].wall, state.wall_contacts[c].grain};
    while (o < walls_.size() && walls_[o] < key) ++o;
    if (o < walls_.size() && walls_[o] == key)
      next.wall_overlap[c] = bound.wall_overlap[o], next.wall_direction[c] = bound.wall_direction[o];
  }
  bound.overlap.swap(next.overlap), bound.weight.swap(next.weight), bound.direction.swap(next.direction);
  bound.wall_overlap.swap(next.wall_overlap), bound.wall_direction.swap(next.wall_direction);
  remember(state);
  return true;
}

bool StandingBounds::add_excess(State& state, const Beyond& contact, std::vector<Index>& open) const {
  const auto& g = state.grains;
  StandingBound& bound = state.policy.bound;
  const Counted &now = contact.now, &before = contact.before;
  const auto more = [](double later, double earlier) { return std::max(0.0, later - earlier); };
  const double kn = more(now.normal, before.normal), kt = more(now.tangential, before.tangential);
  const double couple = std::max(more(now.twisting, before.twisting), more(now.rolling, before.rolling));
  const auto add = [&](Index i, double w) {
    const Inertia inertia = inertia_of(g, i);
    const auto play_of = [&](const Counted& c) {
      const Play p = play(c.normal, c.tangential, c.reach, inertia);
      return Play{w * p.turn + play_of_couple(c.twisting, c.rolling, inertia).turn, w * p.arm};
    };
    const Play later = play_of(now), earlier = play_of(before);
    bound.grain[i] += (w * most_added(kn, kt, inertia) + couple * inertia.inverse_inertia) * sum_rounding +
                      earlier.turn * contact.turned + more(later.arm, earlier.arm);
    bound.turning[i] += more(later.turn, earlier.turn);
    const bool below = bound.grain[i] + bound.turning[i] * std::max(turn_[i], contact.turning) <= bound.value;
    if (!below) open.push_back(i);
    return below;
  };
  if (contact.j == no_index) {
    bound.wall_overlap[contact.entry] = now.reach, bound.wall_direction[contact.entry] = contact.n;
    return add(contact.i, 1);
  }
  const bool split = moves(g, contact.i) && moves(g, contact.j);
  const double t = split ? weight_of(state, contact) : 0.0;
  bound.weight[contact.entry] = t, bound.overlap[contact.entry] = now.reach;
  set_direction(bound, contact.entry, contact.n);
  const bool below = add(contact.i, 1 + t);
  return add(contact.j, split ? 1 + 1 / t : 1.0) && below;
}

bool StandingBounds::allow_more(State& state, const ContactSelection& selection, double time, double slack) {
  const std::size_t asked = selection.grains.size() + selection.walls.size();
  if (asked == 0) return true;
  if (asked * few > state.contacts.size() + state.wall_contacts.size()) return false;
  std::vector<Index> open;
  for (const Beyond& b : look_beyond(scene_, state, selection, turn_, {time, slack})) {
    if (add_excess(state, b, open)) continue;
    outrun_ = outrun_ || b.outran;
  }
  return mend_few(state, open, time);
}

bool StandingBounds::mend_few(State& state, std::vector<Index>& grains, double time) const {
  if (grains.empty()) return true;
  std::ranges::sort(grains);
  grains.erase(std::unique(grains.begin(), grains.end()), grains.end());
  return grains.size() * patched <= state.grains.size() + patched * 16 && mend(scene_, state, grains, time);
}

StandingCheck StandingBounds::check(State& state, double time, double slack) {
  const StandingBound& bound = state.policy.bound;
  take_turn_room(bound, 0.5, turn_);  // the other half is for growth
  const Leave leave{bound, turn_};
  const auto pairs = outgrown_pairs(state, leave, time), walls = outgrown_walls(state, leave, time);
  StandingCheck result;
  outrun_ = false;
  result.outgrown = pairs.size() + walls.size();
  if (allow_more(state, {pairs, walls}, time, slack)) return result;
  result.examined = state.grains.size();
  result.stands = fits(state, time, slack);
  result.outrun = outrun_ && !result.stands;
  return result;
}

bool StandingBounds::check_fresh(State& state, double time, double slack) {
  const StandingBound& bound = state.policy.bound;
  take_turn_room(bound, 1, turn_);  // all of the room may have been promised to the other contacts
  const auto walls = outgrown_walls(state, {bound, turn_}, time);
  return allow_more(state, {fresh_, walls}, time, slack);
}

}  // namespace eg
