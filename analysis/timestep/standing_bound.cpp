#include "timestep/standing_bound.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "assembly/linearise.hpp"
#include "state/damping.hpp"
#include "timestep/outgrown.hpp"
#include "timestep/scalar_weights.hpp"
#include "timestep/splitting.hpp"

namespace eg {
namespace {

constexpr double widest = 100;          // weight
constexpr double most_slack = 2;        // by which an overlap may grow, at most [-]
constexpr double nearest = 0.02;        // room of a grain below the bound, as the weights see it [of the bound]
constexpr double rounding = 1 + 1e-11;  // of sums of a few dozen positive numbers
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

/// The largest that a spring can add to λmax(S_i) of a grain at weight 1 (arm ≤ R) [1/s²].
double most_added(double kn, double kt, double inverse_mass, double inverse_inertia, double radius) {
  return std::max(kn * inverse_mass, kt * (inverse_mass + inverse_inertia * radius * radius));
}

/// Overlaps pressed further by the motion of the time to come, and somewhat larger.
OverlapForecast foreseen(const State& state, const ContactPoint& p, double time, double slack) {
  OverlapForecast f = forecast(state, p.i, p.j, p.geometry, time);
  const double more = slack * std::max(0.0, p.geometry.overlap);
  f.growth += more, f.driven += more;
  return f;
}
/// The same with a slack that leaves the grains of the pair a tenth of the bound, if all their contacts (of Hertz) are
/// given as much: it need not be looked at again for long.
OverlapForecast with_room(const State& state, const ContactPoint& p, double time, double slack) {
  const StandingBound& bound = state.policy.bound;
  const double most = std::max(bound.grain[p.i], p.j == no_index ? 0.0 : bound.grain[p.j]);
  const double stiffer = 0.9 * bound.value / most;
  return foreseen(state, p, time, std::clamp(stiffer * stiffer - 1, slack, most_slack));
}

OverlapGrowth foreseen(const State& state, double time, double slack) {
  return [&state, time, slack](const ContactPoint& p) { return foreseen(state, p, time, slack); };
}

bool moves(const Grains& g, Index i) { return g.velocity[i].w > 0 || (g.rotates() && g.spin[i].w > 0); }

double most_added(const Network& net, const Spring& s, Index grain) {
  return most_added(s.normal, s.tangential, net.inverse_mass[grain], net.rotation ? net.inverse_inertia[grain] : 0.0,
                    net.radius[grain]);
}

/// Moves weights half way (in logarithm) towards centred ones.
std::vector<double> centre(const Sides& sides, const BlockRanges& ranges, double sigma, const std::vector<double>& t) {
  const Network& net = sides.network();
  const auto room = [&](Index g) { return std::max(nearest * sigma, sigma - ranges.high[g]); };
  std::vector<double> next = t;
  for (std::size_t c = 0; c < t.size(); ++c) {
    if (!sides.is_split(c)) continue;
    const Spring& s = net.springs[c];
    next[c] = std::sqrt(t[c] * centred_weight(most_added(net, s, s.i), room(s.i), most_added(net, s, s.j), room(s.j)));
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

double allowed(const StandingBound& bound, const ContactPoint& p) {
  return (p.j == no_index ? bound.wall_overlap : bound.overlap)[p.entry];
}
/// A contact counts as it is seen here.
void allow(StandingBound& bound, const ContactPoint& p) {
  (p.j == no_index ? bound.wall_overlap : bound.overlap)[p.entry] = p.reach;
  if (p.j == no_index)
    bound.wall_direction[p.entry] = p.geometry.n;
  else
    set_direction(bound, p.entry, p.geometry.n);
}

/// What a contact may add to λmax(S_i) of a grain at weight 1 as it moves [1/s²].
struct Play {
  double turn = 0;  ///< for every unit by which its direction is off, |n − n₀|
  double arm = 0;   ///< as its arm follows the overlap, in all
};

/// Of S_i, the block of translations changes by at most |kn − kt| |n − n₀|, that of rotations by kt a² as much, those
/// beside by kt a as much. An arm changes by no more than half of the overlap. `reach`: the overlap allowed [m].
Play play(const Spring& s, double reach, double inverse_mass, double inverse_inertia, double radius) {
  if (s.couple) return {std::abs(s.normal - s.tangential) * inverse_inertia * rounding, 0};
  const double shift = std::abs(s.normal - s.tangential) * inverse_mass,
               turn = s.tangential * radius * radius * inverse_inertia,
               mixed = s.tangential * radius * std::sqrt(inverse_mass * inverse_inertia);
  const double norm = 0.5 * (shift + turn) + std::hypot(0.5 * (shift - turn), mixed);
  return {norm * rounding, (0.5 * mixed + turn) * std::max(0.0, reach) / radius * rounding};
}
Play play(const Network& net, const Spring& s, double reach, Index grain) {
  return play(s, reach, net.inverse_mass[grain], net.rotation ? net.inverse_inertia[grain] : 0.0, net.radius[grain]);
}

/// The sums over the contacts of a grain, at their weights [1/s²].
struct GrainPlay {
  double turn = 0;     ///< for every unit by which all directions are off
  double counted = 0;  ///< to be added to λmax(S_i) of the present directions for a bound about those counted
  double ahead = 0;    ///< … for one that holds until the next check
};
/// `met`: of every spring.
std::vector<GrainPlay> plays_of(const Sides& sides, const std::vector<double>& t, std::span<const SpringMotion> met) {
  const Network& net = sides.network();
  std::vector<GrainPlay> grains(sides.size());
  const auto add = [&](Index g, double weight, const Spring& s, const SpringMotion& m) {
    const Play p = play(net, s, m.reach, g);
    grains[g].turn += weight * p.turn;
    grains[g].counted += weight * (p.arm + p.turn * m.turned);
    grains[g].ahead += weight * (p.arm + p.turn * m.turning);
  };
  for (std::size_t c = 0; c < t.size(); ++c) {
    const Spring& s = net.springs[c];
    const bool split = sides.is_split(c);
    add(s.i, s.i == s.j ? 4 : split ? 1 + t[c] : 1, s, met[c]);
    if (s.j != no_index && s.j != s.i) add(s.j, split ? 1 + 1 / t[c] : 1, s, met[c]);
  }
  return grains;
}

}  // namespace

StandingBounds::Counted StandingBounds::counted(const State& state, const ContactPoint& p) const {
  const auto& velocity = state.grains.velocity;  // w: inverse mass
  const double inverse_mass = velocity[p.i].w + (p.j == no_index ? 0.0 : velocity[p.j].w);
  const double step = state.policy.bound.step;
  Counted c{damped_spring(spring_of(p), inverse_mass, damping_, step), {}, p.reach};
  c.contact.normal *= p.give, c.contact.tangential *= p.give;
  if (state.grains.rotates() && p.has_couple()) {
    c.couple = damped_spring(couple_of(p), inverse_mass, damping_, step);
    c.couple.normal *= 2 * p.give, c.couple.tangential *= 2 * p.give;
  }
  return c;
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
  pair_begin_.clear();
}

double StandingBounds::renew(State& state, const RenewOptions& options) {
  StandingBound& bound = state.policy.bound;
  const auto& list = state.contacts;
  bound.step = options.step;
  damping_ = damping_in_force(scene_, state);
  const bool warm = bound.value > 0 && follow(state);
  bound.overlap.assign(list.size(), 0.0);
  for (std::size_t c = 0; c < list.size(); ++c)
    if (list.is_padding(c)) bound.overlap[c] = INFINITY;
  bound.wall_overlap.assign(state.wall_contacts.size(), 0.0);
  bound.direction.assign(3 * list.size(), 0.0F);
  bound.wall_direction.assign(state.wall_contacts.size(), Vec3{});
  Network network = bare_network(scene_, state);
  network.springs.reserve(list.size() + state.wall_contacts.size());
  std::vector<Spring> couples;            // come last
  std::vector<SpringMotion> met, bent;    // of each spring, each couple
  std::vector<double> start;
  std::vector<std::size_t> entry;  // of each spring between grains
  visit_contacts(
      scene_, state,
      [&](const ContactPoint& p) {
        const Counted c = counted(state, p);
        network.springs.push_back(c.contact);
        add_couple(couples, c.couple);
        met.push_back({p.reach, direction_error, turn_forecast(state, p, options.time)});
        bent.resize(couples.size(), met.back());
        allow(bound, p);
        if (p.j != no_index) entry.push_back(p.entry);
        if (warm) start.push_back(p.j == no_index ? 1.0 : weight_of(state, p.entry, p.i, p.j));
      },
      [&](const ContactPoint& p) {
        return warm ? with_room(state, p, options.time, options.slack)
                    : foreseen(state, p, options.time, options.slack);
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
  needed = splitting_bound(sides, scalars.t, scalars.ranges).value;
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
  StandingBound next;
  next.overlap.resize(list.size()), next.weight.resize(list.size()), next.direction.resize(3 * list.size());
  std::size_t o = 0;
  const auto pair = [](Index i, Index j) { return static_cast<std::uint64_t>(i) << 32 | j; };
  for (std::size_t c = 0; c < list.size(); ++c) {
    if (list.is_padding(c)) {
      next.overlap[c] = INFINITY;
      continue;
    }
    const std::uint64_t key = pair(list.i[c], list.j[c]);
    while (o < i_.size() && (pair(i_[o], j_[o]) < key || std::isinf(bound.overlap[o]))) ++o;
    for (std::size_t k = o; k < i_.size() && pair(i_[k], j_[k]) == key; ++k)
      if (image_.empty() || image_[k] == list.image[c]) {
        next.overlap[c] = bound.overlap[k], next.weight[c] = bound.weight[k];
        set_direction(next, c, counted_direction(bound, k));
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
  const ContactPoint& at = contact.at;
  const Counted now = counted(state, at), &before = contact.before;
  const auto more = [](double later, double earlier) { return std::max(0.0, later - earlier); };
  const double kn = more(now.contact.normal, before.contact.normal),
               kt = more(now.contact.tangential, before.contact.tangential);
  const double couple =
      std::max(more(now.couple.normal, before.couple.normal), more(now.couple.tangential, before.couple.tangential));
  const auto add = [&](Index i, double w) {
    StandingBound& bound = state.policy.bound;
    const double inverse_mass = g.velocity[i].w, inverse_inertia = g.rotates() ? g.spin[i].w : 0.0;
    const auto play_of = [&](const Counted& c) {
      const Play p = play(c.contact, c.reach, inverse_mass, inverse_inertia, g.radius(i));
      return Play{w * p.turn + play(c.couple, 0, inverse_mass, inverse_inertia, g.radius(i)).turn, w * p.arm};
    };
    const Play moves = play_of(now), moved = play_of(before);
    bound.grain[i] +=
        (w * most_added(kn, kt, inverse_mass, inverse_inertia, g.radius(i)) + couple * inverse_inertia) * rounding +
        moved.turn * contact.turned + more(moves.arm, moved.arm);
    bound.turning[i] += more(moves.turn, moved.turn);
    const double off = std::max(turn_[i], contact.turning);
    if (bound.grain[i] + bound.turning[i] * off <= bound.value) return;
    outrun_ = outrun_ || contact.outran;
    if (place_[i] == no_index) place_[i] = 0, doubtful_.push_back(i);
  };
  const bool wall = at.j == no_index;
  const bool split = !wall && moves(g, at.i) && moves(g, at.j);
  const double t = split ? weight_of(state, at.entry, at.i, at.j) : 0.0;
  add(at.i, 1 + t);
  if (!wall) add(at.j, split ? 1 + 1 / t : 1.0), state.policy.bound.weight[at.entry] = t;
}

std::vector<StandingBounds::Beyond> StandingBounds::beyond(const State& state, double time, double slack) {
  const StandingBound& bound = state.policy.bound;
  const Leave leave{bound, turn_};
  const auto pairs = outgrown_pairs(state, leave, time), walls = outgrown_walls(state, leave, time);
  std::vector<Beyond> found;
  visit_contacts(
      scene_, state, {pairs, walls},
      [&](const ContactPoint& p) {
        const double turn = std::min(turn_[p.i], p.j == no_index ? INFINITY : turn_[p.j]);
        const Beyond b{p, turned(state, p), turn_forecast(state, p, time), p.geometry.overlap > allowed(bound, p), {}};
        if (p.reach > allowed(bound, p) * (1 + 1e-9) || (b.turned > 0 && b.turned + b.turning > turn)) found.push_back(b);
      },
      [&](const ContactPoint& p) {
        const double kept = allowed(bound, p) - p.geometry.overlap;
        if (forecast(state, p.i, p.j, p.geometry, time).growth <= kept) return OverlapForecast{kept};
        OverlapForecast f = with_room(state, p, time, slack);
        f.growth = std::max(f.growth, kept), f.driven = std::max(f.driven, kept);
        return f;
      });
  std::vector<std::size_t> entries, wall_entries;
  for (const auto& b : found) (b.at.j == no_index ? wall_entries : entries).push_back(b.at.entry);
  std::size_t k = 0;
  visit_contacts(
      scene_, state, {entries, wall_entries}, [&](const ContactPoint& p) { found[k - 1].before = counted(state, p); },
      [&](const ContactPoint& p) { return ++k, OverlapForecast{allowed(bound, p) - p.geometry.overlap}; });
  return found;
}

StandingCheck StandingBounds::check(State& state, double time, double slack) {
  damping_ = damping_in_force(scene_, state);
  StandingBound& bound = state.policy.bound;
  turn_.resize(state.grains.size());  // half of the room is for growth
  for (std::size_t i = 0; i < turn_.size(); ++i) {
    const double room = 0.5 * std::max(0.0, bound.value - bound.grain[i]);
    turn_[i] = room < bound.turning[i] * straight ? room / bound.turning[i] : straight;
  }
  const auto outgrown = beyond(state, time, slack);
  StandingCheck result;
  result.outgrown = outgrown.size();
  if (outgrown.empty()) return result;

  place_.resize(state.grains.size(), no_index);
  for (const auto& b : outgrown) add_excess(state, b);
  for (const auto& b : outgrown) allow(bound, b.at);
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
  if (pair_begin_.empty()) {
    pair_begin_.assign(state.grains.size() + 2, 0);
    const auto each = [&](auto visit) {
      for (std::size_t c = 0; c < list.size(); ++c)
        if (!list.is_padding(c)) visit(list.i[c], c), visit(list.j[c], c);
    };
    each([&](Index g, std::size_t) { ++pair_begin_[g + 2]; });
    std::partial_sum(pair_begin_.begin(), pair_begin_.end(), pair_begin_.begin());
    pair_.resize(pair_begin_.back());
    each([&](Index g, std::size_t c) { pair_[pair_begin_[g + 1]++] = c; });
  }
  std::vector<std::size_t> pairs;
  for (const Index g : grains)
    pairs.insert(pairs.end(), pair_.begin() + pair_begin_[g], pair_.begin() + pair_begin_[g + 1]);
  std::ranges::sort(pairs);
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
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
        Counted c = counted(state, p);
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

bool StandingBounds::examine(State& state, const std::vector<Index>& grains, const OverlapGrowth& growth,
                             double time) {
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
