#include "timestep/standing_bound.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "assembly/linearise.hpp"
#include "state/damping.hpp"
#include "timestep/allowance.hpp"
#include "timestep/outgrown.hpp"
#include "timestep/scalar_weights.hpp"

namespace eg {
namespace {

constexpr double widest = 100;            // weight
constexpr double nearest = 0.02;          // room of a grain below the bound, as the weights see it [of the bound]
constexpr double direction_error = 1e-7;  // of a unit vector kept in single precision
constexpr double straight = 2;            // no two unit vectors are further apart

/// The weight that leaves both grains of a pair the most room: minimises −ln(σ − S_i) − ln(σ − S_j) in the share of the
/// pair. `a`: what the pair adds to each S at weight 1; `room`: σ − S of each.
double centred_weight(double a_i, double room_i, double a_j, double room_j) {
  const double t = std::sqrt((a_j * room_i) / (a_i * room_j));
  return std::isfinite(t) ? std::clamp(t, 1 / widest, widest) : 1.0;
}

/// |θ_j − θ_i|² ≤ 2|θ_i|² + 2|θ_j|²: couples of twice the stiffness against the ground, on every grain.
void add_couple(std::vector<Spring>& springs, Spring s) {
  if (!s.couple || s.i == s.j) return;
  const Index j = s.j;
  s.j = no_index;
  springs.push_back(s);
  if (j == no_index) return;
  s.i = j;
  springs.push_back(s);
}

bool moves(const Grains& g, Index i) { return g.velocity[i].w > 0 || (g.rotates() && g.spin[i].w > 0); }

/// Moves weights half way (in logarithm) towards centred ones.
std::vector<double> centre(const Sides& sides, const BlockRanges& ranges, double sigma, const std::vector<double>& t) {
  const Network& net = sides.network();
  const auto room = [&](Index g) { return std::max(nearest * sigma, sigma - ranges.high[g]); };
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

/// t of a pair: the one it was given, else the one that the room of its grains suggests.
double weight_of(const State& state, std::size_t entry, Index i, Index j) {
  const StandingBound& bound = state.policy.bound;
  if (entry < bound.weight.size() && bound.weight[entry] > 0) return bound.weight[entry];
  const auto& velocity = state.grains.velocity;  // w: inverse mass
  const auto room = [&](Index g) { return std::max(nearest * bound.value, bound.value - bound.grain[g]); };
  return centred_weight(velocity[i].w, room(i), velocity[j].w, room(j));
}

/// S_i of one grain.
Block block_of(const Sides& sides, const std::vector<double>& t, Index grain) {
  return sides.block(grain, [&](const Side& side) -> Eigen::Matrix3d {
    const Spring& s = sides.network().springs[side.spring];
    double w = 1;
    if (side.role != Side::Role::alone) w += side.role == Side::Role::first ? t[side.spring] : 1 / t[side.spring];
    const Eigen::Vector3d n(s.n.x, s.n.y, s.n.z);
    return w * (s.tangential * Eigen::Matrix3d::Identity() + (s.normal - s.tangential) * n * n.transpose());
  });
}

/// By how much all directions of a grain's contacts may be off.
double turn_room(const StandingBound& bound, std::size_t i) {
  const double room = std::max(0.0, bound.value - bound.grain[i]);
  return room < bound.turning[i] * straight ? room / bound.turning[i] : straight;
}

double allowed(const StandingBound& bound, const ContactPoint& p) {
  return (p.j == no_index ? bound.wall_overlap : bound.overlap)[p.entry];
}
/// A contact counts with this overlap and direction.
void allow(StandingBound& bound, std::size_t entry, bool wall, double reach, const Vec3& n) {
  (wall ? bound.wall_overlap : bound.overlap)[entry] = reach;
  if (wall)
    bound.wall_direction[entry] = n;
  else
    set_direction(bound, entry, n);
}

/// No λmax(S_i) is above.
double largest_block(const Sides& sides, const std::vector<double>& t, const BlockRanges& ranges) {
  double most = largest(ranges.low);
  for (Index g = 0; g < sides.size(); ++g)
    if (ranges.high[g] > most)
      most = std::max(most, std::min(ranges.high[g], block_upper_bound(block_of(sides, t, g), sides.of(g).size())));
  return most;
}

}  // namespace

StandingBounds::Springs StandingBounds::springs_of(const State& state, const ContactPoint& p) const {
  const auto& velocity = state.grains.velocity;
  const double inverse_mass = velocity[p.i].w + (p.j == no_index ? 0.0 : velocity[p.j].w);
  const double step = state.policy.bound.step;
  Springs c{damped_spring(spring_of(p), inverse_mass, damping_, step), {}};
  c.contact.normal *= p.give, c.contact.tangential *= p.give;
  if (state.grains.rotates() && p.has_couple()) {
    c.couple = damped_spring(couple_of(p), inverse_mass, damping_, step);
    c.couple.normal *= 2 * p.give, c.couple.tangential *= 2 * p.give;
  }
  return c;
}

StandingBounds::Counted StandingBounds::counted(const State& state, const ContactPoint& p) const {
  const Springs c = springs_of(state, p);
  return {c.contact.normal, c.contact.tangential, c.couple.normal, c.couple.tangential, p.reach};
}

double StandingBounds::turned(const State& state, const ContactPoint& p) {
  const StandingBound& bound = state.policy.bound;
  const Vec3 from = p.j == no_index ? bound.wall_direction[p.entry] : counted_direction(bound, p.entry);
  return norm(from) > 0 ? norm(p.geometry.n - from) + direction_error : 0.0;
}

void StandingBounds::remember(const State& state) {
  const auto& list = state.contacts;
  i_ = list.i, j_ = list.j, image_ = list.image, id_ = state.grains.id;
  walls_.clear();
  for (const auto& w : state.wall_contacts) walls_.push_back({w.wall, w.grain});
}

double StandingBounds::renew(State& state, const RenewOptions& options) {
  StandingBound& bound = state.policy.bound;
  const auto& list = state.contacts;
  bound.step = options.step;
  damping_ = damping_in_force(scene_, state);
  const bool warm = bound.value > 0 && follow(state);
  const double usual = usual_overlap(bound);
  bound.overlap.assign(list.size(), 0.0);
  for (std::size_t c = 0; c < list.size(); ++c)
    if (list.is_padding(c)) bound.overlap[c] = INFINITY;
  bound.wall_overlap.assign(state.wall_contacts.size(), 0.0);
  bound.direction.assign(3 * list.size(), 0.0F);
  bound.wall_direction.assign(state.wall_contacts.size(), Vec3{});
  Network network = bare_network(scene_, state);
  network.springs.reserve(list.size() + state.wall_contacts.size());
  std::vector<Spring> couples;          // come last
  std::vector<SpringMotion> met, bent;  // of each spring, each couple
  std::vector<double> start;
  std::vector<std::size_t> entry;  // of each spring between grains
  visit_contacts(
      scene_, state,
      [&](const ContactPoint& p) {
        const Springs c = springs_of(state, p);
        network.springs.push_back(c.contact);
        add_couple(couples, c.couple);
        met.push_back({p.reach, direction_error, turn_forecast(state, p, options.time)});
        bent.resize(couples.size(), met.back());
        allow(bound, p.entry, p.j == no_index, p.reach, p.geometry.n);
        if (p.j != no_index) entry.push_back(p.entry);
        if (warm) start.push_back(p.j == no_index ? 1.0 : weight_of(state, p.entry, p.i, p.j));
      },
      [&](const ContactPoint& p) {
        const OverlapForecast f = forecast(state, p.i, p.j, p.geometry, options.time);
        return warm ? with_room(bound, f, p, options.slack, usual, 0.7) : with_slack(f, p, options.slack);
      });
  network.springs.insert(network.springs.end(), couples.begin(), couples.end());
  met.insert(met.end(), bent.begin(), bent.end());
  if (warm) start.resize(network.springs.size(), 1.0);
  bound.weight.assign(list.size(), 0.0);

  const Sides sides(network);
  ScalarWeights scalars = sweep_scalars(sides, {.most = warm ? 4 : 8, .start = start});
  double needed = largest(scalars.ranges.low);
  bound.value = std::max(options.floor, needed * (1 + options.room));
  spread_out(sides, bound.value, warm ? 1 : 3, scalars);
  needed = largest_block(sides, scalars.t, scalars.ranges);
  for (std::size_t k = 0; k < entry.size(); ++k) bound.weight[entry[k]] = scalars.t[k];
  bound.grain = std::move(scalars.ranges.high);
  bound.turning.resize(bound.grain.size());
  const std::vector<GrainPlay> plays = plays_of(sides, scalars.t, met);
  double most = 0;
  for (Index g = 0; g < bound.grain.size(); ++g) {
    bound.grain[g] = std::min(bound.grain[g], needed);
    most = std::max(most, bound.grain[g] + std::max(plays[g].counted, plays[g].ahead));
    bound.grain[g] += plays[g].counted, bound.turning[g] = plays[g].turn;
  }
  bound.value = std::max(bound.value, most * (1 + 0.2 * options.room));
  remember(state);

  std::vector<Index> stiffest;
  for (Index g = 0; g < bound.grain.size(); ++g)
    if (scalars.ranges.low[g] > 0.9 * needed) stiffest.push_back(g);
  stiffest.resize(std::min<std::size_t>(stiffest.size(), 64));
  return largest_self_block(Sides(part(state, stiffest, {}, 0, false).network)) * (1 - 1e-12);
}

bool StandingBounds::follow(State& state) {
  StandingBound& bound = state.policy.bound;
  const auto& list = state.contacts;
  if (id_ != state.grains.id || bound.overlap.size() != i_.size()) return false;
  const auto pair = [](Index i, Index j) { return static_cast<std::uint64_t>(i) << 32 | j; };
  StandingBound next;
  next.overlap.resize(list.size()), next.weight.resize(list.size()), next.direction.resize(3 * list.size());
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
  next.wall_overlap.resize(state.wall_contacts.size()), next.wall_direction.resize(state.wall_contacts.size());
  o = 0;
  for (std::size_t c = 0; c < state.wall_contacts.size(); ++c) {
    const std::array<Index, 2> key{state.wall_contacts[c].wall, state.wall_contacts[c].grain};
    while (o < walls_.size() && walls_[o] < key) ++o;
    if (o < walls_.size() && walls_[o] == key)
      next.wall_overlap[c] = bound.wall_overlap[o], next.wall_direction[c] = bound.wall_direction[o];
  }
  bound.overlap = std::move(next.overlap), bound.weight = std::move(next.weight);
  bound.direction = std::move(next.direction);
  bound.wall_overlap = std::move(next.wall_overlap), bound.wall_direction = std::move(next.wall_direction);
  remember(state);
  return true;
}

void StandingBounds::add_excess(State& state, const Beyond& contact) {
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
    if (bound.grain[i] + bound.turning[i] * std::max(turn_[i], contact.turning) <= bound.value) return;
    outrun_ = outrun_ || contact.outran;
    if (place_[i] == no_index) place_[i] = 0, doubtful_.push_back(i);
  };
  const bool wall = contact.j == no_index;
  const bool split = !wall && moves(g, contact.i) && moves(g, contact.j);
  const double t = split ? weight_of(state, contact.entry, contact.i, contact.j) : 0.0;
  add(contact.i, 1 + t);
  if (!wall) add(contact.j, split ? 1 + 1 / t : 1.0), bound.weight[contact.entry] = t;
  allow(bound, contact.entry, wall, now.reach, contact.n);
}

void StandingBounds::find_beyond(const State& state, const ContactSelection& selection, double time, double slack) {
  const StandingBound& bound = state.policy.bound;
  const double usual = usual_overlap(bound);
  beyond_.clear();
  visit_contacts(
      scene_, state, selection,
      [&](const ContactPoint& p) {
        const double turned = StandingBounds::turned(state, p), turning = turn_forecast(state, p, time);
        const double least = std::min(turn_[p.i], p.j == no_index ? INFINITY : turn_[p.j]), may = allowed(bound, p);
        if (p.reach > may * (1 + 1e-9) || (turned > 0 && turned + turning > least))
          beyond_.push_back(
              {p.i, p.j, p.entry, p.geometry.n, turned, turning, p.geometry.overlap > may, counted(state, p), {}});
      },
      [&](const ContactPoint& p) {
        const double kept = allowed(bound, p) - p.geometry.overlap;
        OverlapForecast f = forecast(state, p.i, p.j, p.geometry, time);
        if (f.growth <= kept) return OverlapForecast{kept};
        f = with_room(bound, f, p, slack, usual, 0.9);
        f.growth = std::max(f.growth, kept), f.driven = std::max(f.driven, kept);
        return f;
      });
  std::vector<std::size_t> entries, wall_entries;  // of those that were counted already
  std::vector<std::size_t> places;
  for (std::size_t k = 0; k < beyond_.size(); ++k) {
    const bool wall = beyond_[k].j == no_index;
    if ((wall ? bound.wall_overlap : bound.overlap)[beyond_[k].entry] == 0) continue;
    (wall ? wall_entries : entries).push_back(beyond_[k].entry), places.push_back(k);
  }
  std::size_t k = 0;
  visit_contacts(
      scene_, state, {entries, wall_entries},
      [&](const ContactPoint& p) { beyond_[places[k - 1]].before = counted(state, p); },
      [&](const ContactPoint& p) { return ++k, OverlapForecast{allowed(bound, p) - p.geometry.overlap}; });
}

StandingCheck StandingBounds::check(State& state, double time, double slack) {
  const StandingBound& bound = state.policy.bound;
  turn_.resize(state.grains.size());  // half of the room is for growth
  for (std::size_t i = 0; i < turn_.size(); ++i) turn_[i] = 0.5 * turn_room(bound, i);
  const Leave leave{bound, turn_};
  const auto pairs = outgrown_pairs(state, leave, time), walls = outgrown_walls(state, leave, time);
  return check(state, {pairs, walls}, time, slack);
}

StandingCheck StandingBounds::check_fresh(State& state, double time, double slack) {
  const StandingBound& bound = state.policy.bound;
  turn_.resize(state.grains.size());  // all of the room may have been promised to the other contacts
  for (std::size_t i = 0; i < turn_.size(); ++i) turn_[i] = turn_room(bound, i);
  const auto walls = outgrown_walls(state, {bound, turn_}, time);
  return check(state, {fresh_, walls}, time, slack);
}

StandingCheck StandingBounds::check(State& state, const ContactSelection& selection, double time, double slack) {
  damping_ = damping_in_force(scene_, state);
  const StandingBound& bound = state.policy.bound;
  find_beyond(state, selection, time, slack);
  StandingCheck result;
  result.outgrown = beyond_.size();
  place_.resize(state.grains.size(), no_index);
  for (const auto& b : beyond_) add_excess(state, b);
  result.outrun = std::exchange(outrun_, false);
  const std::vector<Index> doubtful = std::move(doubtful_);
  doubtful_.clear();
  for (const Index i : doubtful) place_[i] = no_index;
  result.examined = doubtful.size();
  const OverlapGrowth as_allowed = [&](const ContactPoint& p) {
    return OverlapForecast{allowed(bound, p) - p.geometry.overlap};
  };
  result.stands = doubtful.empty() || examine(state, doubtful, as_allowed, time) ||
                  examine(state, doubtful, foreseen(state, time, slack), time) ||
                  examine(state, doubtful, foreseen(state, time, 0), time);
  return result;
}

std::vector<std::size_t> StandingBounds::pairs_of(const State& state, const std::vector<Index>& grains) {
  const auto& list = state.contacts;
  asked_.assign(state.grains.size(), 0);
  for (const Index g : grains) asked_[g] = 1;
  std::vector<std::size_t> pairs;
  for (std::size_t c = 0; c < list.size(); ++c)
    if ((asked_[list.i[c]] | asked_[list.j[c]]) != 0 && !list.is_padding(c)) pairs.push_back(c);
  return pairs;
}

StandingBounds::Part StandingBounds::part(const State& state, const std::vector<Index>& grains,
                                          const OverlapGrowth& growth, double time, bool couples) {
  const auto& g = state.grains;
  place_.resize(g.size(), no_index);
  Part out;
  Network& net = out.network;
  net.dimension = scene_.dimension, net.rotation = g.rotates();
  const auto place = [&](Index i) {
    if (place_[i] == no_index) {
      place_[i] = static_cast<Index>(net.size());
      net.inverse_mass.push_back(g.velocity[i].w), net.radius.push_back(g.radius(i)), net.id.push_back(i);
      if (net.rotation) net.inverse_inertia.push_back(g.spin[i].w);
    }
    return place_[i];
  };
  for (const Index i : grains) place(i);
  out.pairs = pairs_of(state, grains);
  for (std::size_t c = 0; c < state.wall_contacts.size(); ++c)
    if (place_[state.wall_contacts[c].grain] < grains.size()) out.walls.push_back(c);
  out.pair_reach.assign(out.pairs.size(), 0.0), out.wall_reach.assign(out.walls.size(), 0.0);
  auto next_pair = out.pairs.begin(), next_wall = out.walls.begin();
  visit_contacts(
      scene_, state, {out.pairs, out.walls},
      [&](const ContactPoint& p) {
        if (p.j == no_index) {
          next_wall = std::find(next_wall, out.walls.end(), p.entry);
          out.wall_reach[static_cast<std::size_t>(next_wall - out.walls.begin())] = p.reach;
        } else {
          next_pair = std::find(next_pair, out.pairs.end(), p.entry);
          out.pair_reach[static_cast<std::size_t>(next_pair - out.pairs.begin())] = p.reach;
        }
        Springs c = springs_of(state, p);
        for (Spring* s : {&c.contact, &c.couple}) {
          s->i = place(p.i);
          if (p.j != no_index) s->j = place(p.j);
        }
        net.springs.push_back(c.contact);
        out.entry.push_back(p.j == no_index ? no_entry : p.entry);
        if (couples) add_couple(net.springs, c.couple);
        out.entry.resize(net.springs.size(), no_entry);
        out.met.resize(net.springs.size(), {p.reach, turned(state, p), turn_forecast(state, p, time)});
      },
      growth);
  for (const Index i : net.id) place_[i] = no_index;
  return out;
}

bool StandingBounds::examine(State& state, const std::vector<Index>& grains, const OverlapGrowth& growth, double time) {
  StandingBound& bound = state.policy.bound;
  const Part stiff = part(state, grains, growth, time, true);
  const Network& net = stiff.network;
  std::vector<double> t(net.springs.size(), 1.0);
  for (std::size_t k = 0; k < t.size(); ++k)
    if (const Spring& s = net.springs[k]; s.j != no_index)
      t[k] = weight_of(state, stiff.entry[k], net.id[s.i], net.id[s.j]);
  const Sides sides(net);
  BlockRanges ranges(net.size());
  std::vector<Index> first(grains.size());
  std::iota(first.begin(), first.end(), Index{0});
  block_ranges(sides, t, first, ranges);
  const std::vector<GrainPlay> plays = plays_of(sides, t, stiff.met);
  for (const Index k : first) {
    const double most = bound.value - std::max(plays[k].counted, plays[k].ahead);
    if (!(ranges.high[k] < most) && !block_is_below(block_of(sides, t, k), sides.of(k).size(), most)) return false;
  }
  for (const Index k : first) {
    bound.grain[grains[k]] = std::min(ranges.high[k] + plays[k].counted, bound.value);
    bound.turning[grains[k]] = plays[k].turn;
  }
  // what these pairs are allowed is now what they were counted at, never more than before
  for (std::size_t k = 0; k < stiff.pairs.size(); ++k)
    bound.overlap[stiff.pairs[k]] = std::min(bound.overlap[stiff.pairs[k]], stiff.pair_reach[k]);
  for (std::size_t k = 0; k < stiff.walls.size(); ++k)
    bound.wall_overlap[stiff.walls[k]] = std::min(bound.wall_overlap[stiff.walls[k]], stiff.wall_reach[k]);
  return true;
}

}  // namespace eg
