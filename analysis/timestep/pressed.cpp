#include "timestep/pressed.hpp"

#include <algorithm>
#include <cmath>

#include "assembly/damped_stiffness.hpp"
#include "assembly/linearise.hpp"
#include "base/power.hpp"
#include "contact/lanes.hpp"
#include "contact/laws.hpp"
#include "state/damping.hpp"
#include "state/friction.hpp"
#include "state/wall_geometry.hpp"
#include "state/yielding.hpp"
#include "timestep/outgrown.hpp"

namespace eg {
namespace {

constexpr double most_slack = 2;  // by which an overlap may grow beyond what is foreseen, at most [-]
constexpr double up_to = 0.8;     // of the bound: what contacts are given of the room of their grains
constexpr double near = 0.5;      // of that, for pairs that do not touch yet, by which they count before they do
constexpr double widest = 100;    // weight
constexpr double nearest = 0.02;  // room of a grain below the bound, as the weights see it [of the bound]
constexpr std::size_t lanes = Contacts::lanes;

template <class S>
S clamp(const S& x, double low, double high) {
  return min(max(x, S(low)), S(high));
}

/// Half of what contacts are allowed on average [m].
double usual_overlap(const StandingBound& bound) {
  Batch total(0.0), count(0.0);
  const Batch zero(0.0), one(1.0);
  for (std::size_t c = 0; c < bound.overlap.size(); c += lanes) {
    const Batch x = load_lanes(bound.overlap.data() + c);
    const Mask counts = (x > zero) & (x < Batch(INFINITY));
    total = total + select(counts, x, zero), count = count + select(counts, one, zero);
  }
  return sum(count) > 0 ? 0.5 * sum(total) / sum(count) : 0.0;
}

/// A contact as it is, and how it moves.
template <class S>
struct Met {
  Geometry<S> g;
  S radius_i, radii;  ///< R_i, R_i + R_j; wall: R twice
  S inverse_mass;     ///< 1/m_i + 1/m_j
  S distance;         ///< length of the branch
  Approach<S> approach;
};

enum class Scope { all, some };  ///< of the contacts

/// What is asked about all contacts alike.
template <class Law>
class Presser {
 public:
  Presser(const Scene& scene, const State& state, const PressOptions& options, Scope scope, double usual)
      : state_(state),
        bound_(state.policy.bound),
        options_(options),
        motion_(state),
        arms_(arms_of(scene)),
        kinds_(scene.materials.size()),
        constants_(pair_constants<Law>(scene.materials, friction_in_force(scene, state), scene.dimension)),
        damping_(damping_in_force(scene, state)),
        yields_(glued_that_yield(state)),
        usual_(usual),
        rows_(scope == Scope::all ? state.grains.size() : 0) {
    const bool warm = bound_.value > 0;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const Inertia inertia = inertia_of(state.grains, static_cast<Index>(i));
      const double b = warm ? bound_.grain[i] : 0.0;
      rows_[i] = {b, room_below(bound_.value, b), inertia.inverse_mass,
                  inertia.inverse_mass + inertia.inverse_inertia * inertia.radius * inertia.radius};
    }
  }

  /// Eight pairs, into the network.
  void press(std::size_t c, StandingBound& bound, Pressed& out) const {
    const Eight e = take(c, bound);
    store(c, e, out);
    const Batch old = options_.looked.empty() ? Batch(0.0) : load_lanes(options_.looked.data() + c);
    store_lanes(out.weight.data() + c, options_.looked.empty() ? e.weight : select(old > Batch(0.0), old, Batch(1.0)));
    if constexpr (HasCouples<Law>)
      for (std::size_t k = 0; k < lanes; ++k)
        if (!state_.contacts.is_padding(c + k)) set_couples(c + k, e.couples[k], out);
  }
  void press_wall(std::size_t w, StandingBound& bound, Pressed& out) const {
    const WallSpring found = take_wall(w, bound);
    const std::size_t at = state_.contacts.size() + w;
    const Spring layout = out.network.springs[at];
    out.network.springs[at] = found.spring;
    out.network.springs[at].i = layout.i, out.network.springs[at].j = layout.j;
    out.motion[at] = {found.counted.reach, direction_error, found.turning};
    set_couples(at, found.counted, out);
  }

  /// Eight pairs, into the sums of their grains.
  void add(std::size_t c, StandingBound& bound, Look& out) const {
    const Eight e = take(c, bound);
    const Batch zero(0.0), one(1.0);
    for (std::size_t k = 0; k < lanes; ++k) out.outran[c + k] = lane(e.outran, k);
    const Mask counts = (e.kn > zero) | (e.kt > zero);
    store_lanes(out.weight.data() + c, select(counts, e.weight, zero));
    if (!any(counts)) return;
    const EightContacts contacts = taken_in(e, counts);
    const Mask split = (e.most_i > zero) & (e.most_j > zero);
    const Batch w_i = select(split, one + e.weight, one), w_j = select(split, one + one / e.weight, one);
    const Index *i = state_.contacts.i.data() + c, *j = state_.contacts.j.data() + c,
                *target = out.schedule.target.data() + c;
    for (std::size_t k = 0; k < lanes; ++k) {
      if (!lane(counts, k)) continue;
      if (i[k] == j[k]) {
        add_own_image(out.rows[i[k]], e, k);
        continue;
      }
      add_contact(out.rows[i[k]], contacts, k, w_i[k], -e.m.g.arm_i[k]);
      add_contact(out.rows[target[k]], contacts, k, w_j[k], e.m.g.arm_j[k]);
      if constexpr (HasCouples<Law>)
        for (const Index g : {i[k], target[k]})
          add_couples(out.rows[g], {e.m.g.n.x[k], e.m.g.n.y[k], e.m.g.n.z[k]}, e.couples[k], e.turning[k]);
    }
  }
  void add_wall(std::size_t w, StandingBound& bound, Look& out) const {
    const WallSpring found = take_wall(w, bound);
    const Spring& s = found.spring;
    out.outran[state_.contacts.size() + w] = found.outran;
    if (!acts(s) && found.counted.rolling == 0 && found.counted.twisting == 0) return;
    GrainSums& row = out.rows[state_.wall_contacts[w].grain];
    add_side(row.block, s, {}, 1);
    const double stretch = std::abs(s.normal - s.tangential);
    row.play += Double8{
        stretch, s.tangential * found.counted.reach, stretch * found.turning, s.tangential * found.turning, 0, 0, 0, 0};
    add_couples(row, s.n, found.counted, found.turning);
  }

  /// Adds the contact if it counts for anything.
  void count(std::size_t c, std::vector<CountedContact>& found) const {
    const auto m = met<double>(c);
    add_counted({state_.contacts.i[c], state_.contacts.j[c], c, {}, {}, counted(c, m, bound_.overlap[c])}, m,
                counted_direction(bound_, c), found);
  }
  void count_wall(std::size_t w, std::vector<CountedContact>& found) const {
    const auto m = met_wall(w);
    add_counted({state_.wall_contacts[w].grain, no_index, w, {}, {}, counted_wall(w, m, bound_.wall_overlap[w])}, m,
                bound_.wall_direction[w], found);
  }

  /// Adds the contact if it may be beyond what it is allowed.
  void look(std::size_t c, std::span<const double> turn, std::vector<Beyond>& found) const {
    const Index i = state_.contacts.i[c], j = state_.contacts.j[c];
    const auto m = met<double>(c);
    const Vec3 from = counted_direction(bound_, c);
    const auto pair = this->pair<double>(c, m);
    const double may = bound_.overlap[c], ahead = foreseen(pair, m);
    if (!is_beyond(m, from, may, ahead, std::min(turn[i], turn[j]))) return;
    const double reach = allowed(m, ahead, std::max(bound_.grain[i], bound_.grain[j]), may);
    found.push_back({i, j, c, m.g.n, turned(m, from), m.approach.turning * options_.time, m.g.overlap > may,
                     counted(c, m, std::max(may, reach)), norm(from) > 0 ? counted(c, m, may) : Counted{}});
  }
  void look_wall(std::size_t w, std::span<const double> turn, std::vector<Beyond>& found) const {
    const Index i = state_.wall_contacts[w].grain;
    const auto m = met_wall(w);
    const Vec3 from = bound_.wall_direction[w];
    const auto pair = wall_pair(w);
    const double may = bound_.wall_overlap[w], ahead = foreseen(pair, m);
    if (!is_beyond(m, from, may, ahead, turn[i])) return;
    const double reach = allowed(m, ahead, bound_.grain[i], may);
    found.push_back({i, no_index, w, m.g.n, turned(m, from), m.approach.turning * options_.time, m.g.overlap > may,
                     counted_wall(w, m, std::max(may, reach)), norm(from) > 0 ? counted_wall(w, m, may) : Counted{}});
  }

 private:
  template <class S>
  using Pair = typename Law::template Pair<S>;
  template <class S>
  using Constants = typename Law::template Constants<S>;

  struct NoCouples {};
  /// Eight pairs as they may be.
  struct Eight {
    Met<Batch> m;
    Batch reach, kn, kt, weight, turning;
    Batch most_i, most_j;  ///< what a stiffness of 1 adds to either grain at most: 0 for one that cannot move
    Mask outran;
    [[no_unique_address]] std::conditional_t<HasCouples<Law>, std::array<Counted, lanes>, NoCouples> couples;
  };
  struct WallSpring {
    Spring spring;
    Counted counted;
    double turning;
    bool outran;
  };

  /// Sets what they are allowed.
  Eight take(std::size_t c, StandingBound& bound) const {
    const Index *i = state_.contacts.i.data() + c, *j = state_.contacts.j.data() + c;
    const Batch zero(0.0);
    Eight e;
    e.m = met<Batch>(c);
    const Columns<Batch> side_i = load_rows<Batch>(rows_.data(), i), side_j = load_rows<Batch>(rows_.data(), j);
    const auto pair = this->pair<Batch>(c, e.m);
    const Mask real = e.m.distance > Batch(1e-140);  // padding has no length
    const Batch before = select(real, max(load_lanes(bound.overlap.data() + c), zero), zero);
    e.reach = before;
    if (options_.looked.empty())
      e.reach = select(real, allowed(e.m, foreseen(pair, e.m), max(side_i.x, side_j.x), before), zero);
    const NormalResponse<Batch> at = response(pair, e.reach);
    const Mask counts = e.reach > zero;
    e.kn = select(counts, damped(at.stiffness, e.m.inverse_mass, damping_.normal_ratio), zero);
    e.kt = select(counts, damped(at.tangential, e.m.inverse_mass, damping_.shear_ratio), zero);
    e.weight = weights(c, side_i, side_j, e.kn, e.kt);
    e.most_i = side_i.w, e.most_j = side_j.w;
    e.turning = e.m.approach.turning * Batch(options_.time);
    e.outran = real & (e.m.g.overlap > before);
    if (HasCouples<Law> || !yields_.empty()) correct(c, e);
    const Mask acts = (e.kn > zero) | (e.kt > zero);
    store_lanes(bound.overlap.data() + c, select(real, e.reach, Batch(INFINITY)));
    const Vec<Batch>& n = e.m.g.n;
    set_directions(bound, c, {select(acts, n.x, zero), select(acts, n.y, zero), select(acts, n.z, zero)});
    return e;
  }
  /// What bonds, couples and bodies that yield make of eight pairs.
  void correct(std::size_t c, Eight& e) const {
    for (std::size_t k = 0; k < lanes; ++k) {
      if constexpr (HasCouples<Law>) {
        e.couples[k] = {};
        if (state_.contacts.is_padding(c + k)) continue;
        e.couples[k] = counted(c + k, met<double>(c + k), e.reach[k]);
        e.kn.v[k] = e.couples[k].normal, e.kt.v[k] = e.couples[k].tangential;
      } else if (!state_.contacts.is_padding(c + k)) {
        e.kn.v[k] *= give(c + k), e.kt.v[k] *= give(c + k);
      }
    }
  }
  WallSpring take_wall(std::size_t w, StandingBound& bound) const {
    const auto m = met_wall(w);
    const double before = bound.wall_overlap[w];
    const double reach = options_.looked.empty()
                             ? allowed(m, foreseen(wall_pair(w), m), rows_[state_.wall_contacts[w].grain].x, before)
                             : before;
    WallSpring found;
    found.counted = counted_wall(w, m, reach);
    found.turning = m.approach.turning * options_.time, found.outran = m.g.overlap > std::max(before, 0.0);
    Spring& s = found.spring;
    s.arm_i = m.g.arm_i, s.normal = found.counted.normal, s.tangential = found.counted.tangential, s.n = m.g.n;
    bound.wall_overlap[w] = found.counted.reach, bound.wall_direction[w] = acts(s) ? m.g.n : Vec3{};
    return found;
  }

  EG_INLINE static EightContacts taken_in(const Eight& e, Mask counts) {
    const Batch zero(0.0), stretch = e.kn - e.kt, both = abs(stretch);
    const Batch x = select(counts, e.m.g.n.x, zero), y = select(counts, e.m.g.n.y, zero),
                z = select(counts, e.m.g.n.z, zero);
    const Batch xx = x * x, yy = y * y, zz = z * z, yz = y * z, xz = x * z, xy = x * y;
    EightContacts out;
    transpose_columns({stretch * xx, stretch * yy, stretch * zz, stretch * yz},
                      {stretch * xz, stretch * xy, e.kt, e.kt * x}, out.first);
    transpose_columns({e.kt * xx, e.kt * yy, e.kt * zz, e.kt * yz}, {e.kt * xz, e.kt * xy, e.kt * y, e.kt * z},
                      out.second);
    transpose_columns({both, e.kt * e.reach, both * e.turning, e.kt * e.turning}, out.play);
    return out;
  }
  /// A pair of a grain and its own image only turns: its ends move alike.
  static void add_own_image(GrainSums& row, const Eight& e, std::size_t k) {
    Spring s;
    s.arm_i = e.m.g.arm_i[k], s.arm_j = e.m.g.arm_j[k], s.tangential = e.kt[k];
    s.n = {e.m.g.n.x[k], e.m.g.n.y[k], e.m.g.n.z[k]};
    add_side(row.block, s, {.own_image = true}, 1);
    const double turn = 4 * e.kt[k] * e.m.radius_i[k] * e.m.radius_i[k];
    row.play += Double8{0, 4 * e.kt[k] * e.reach[k], 0, 0, turn, turn * e.turning[k], 0, 0};
  }
  static void add_couples(GrainSums& row, const Vec3& n, const Counted& c, double turning) {
    if (c.twisting == 0 && c.rolling == 0) return;
    Spring s;
    s.normal = c.twisting, s.tangential = c.rolling, s.n = n;
    add_couple(row.block, s, 1);
    const double k = std::abs(c.twisting - c.rolling);
    row.play += Double8{0, 0, 0, 0, k, k * turning, 0, 0};
  }

  template <class S>
  Met<S> met(std::size_t c) const {
    const auto& list = state_.contacts;
    BothSides<S> both;
    load_sides<false, S>(both, state_.grains.position.data(), state_.grains.velocity.data(), nullptr, list.i.data() + c,
                         list.j.data() + c, motion_.shift.data(), list.image.empty() ? nullptr : list.image.data() + c);
    Met<S> m;
    const Vec<S> branch = xyz(both.branch);
    m.g = grain_grain(branch, both.radius_i, both.branch.w, arms_);
    m.radius_i = both.radius_i, m.radii = both.branch.w, m.inverse_mass = both.velocity.w;
    m.distance = m.radii - m.g.overlap;
    m.approach = motion_.approach(m.g.n, branch, xyz(both.velocity), reciprocal(max(m.distance, S(1e-300))));
    return m;
  }

  Met<double> met_wall(std::size_t w) const {
    const auto& contact = state_.wall_contacts[w];
    const Quad& p = state_.grains.position[contact.grain];
    const auto g = grain_wall(state_, state_.walls[contact.wall], p.vec(), p.w, arms_);
    return {g,
            p.w,
            2 * p.w,
            state_.grains.velocity[contact.grain].w,
            p.w - g.overlap,
            motion_.at_wall(state_, contact, g.n)};
  }

  template <class S>
  Pair<S> pair(std::size_t c, const Met<S>& m) const {
    const Index *i = state_.contacts.i.data() + c, *j = state_.contacts.j.data() + c;
    const auto& grains = state_.grains;
    const auto sizes = grain_sizes(m.radius_i, m.radii - m.radius_i);
    if (constants_.size() == 1)
      return Law::template pair<S>(broadcast_struct<Constants<S>, S>(constants_.front()), sizes);
    const auto kind = [&](std::size_t k) { return grains.material_of(i[k]) * kinds_ + grains.material_of(j[k]); };
    return Law::template pair<S>(gather_struct<Constants<S>, S>(constants_.data(), kind), sizes);
  }
  Pair<double> wall_pair(std::size_t w) const {
    const auto& contact = state_.wall_contacts[w];
    const auto kind = state_.grains.material_of(contact.grain) * kinds_ + state_.walls[contact.wall].material;
    return Law::template pair<double>(constants_[kind], wall_sizes(state_.grains.radius(contact.grain)));
  }

  template <class S>
  NormalResponse<S> response(const Pair<S>& pair, const S& overlap) const {
    auto n = Law::template normal<S>(pair, overlap);
    if (state_.contacts.history_vectors == 0) n.tangential = S(0.0);
    return n;
  }
  template <class S>
  S damped(const S& stiffness, const S& inverse_mass, double ratio) const {
    return damped_stiffness(stiffness, inverse_mass, ratio, damping_.local, bound_.step);
  }

  /// N²/(2 kn), the energy of a linear spring of that force and stiffness: no more than a contact stores that stiffens.
  template <class S>
  static S stored(const NormalResponse<S>& n) {
    return select(n.force > S(0.0), S(0.5) * n.force * n.force * reciprocal(max(n.stiffness, S(1e-300))), S(0.0));
  }

  /// The overlap grown, but no further than to where the energy is taken up that approaches, and twice what is stored;
  /// in any case as far as it is driven. A step is exact for the power laws of springs and Hertz contacts.
  template <class S>
  S foreseen(const Pair<S>& pair, const Met<S>& m) const {
    const S growth = m.approach.speed * S(options_.time), grown = m.g.overlap + growth;
    const S energy = select(m.inverse_mass > S(0.0),
                            m.approach.speed * m.approach.speed * reciprocal(max(m.inverse_mass, S(1e-300))), S(0.0));
    const S most = energy + S(2.0) * stored(Law::template normal<S>(pair, max(m.g.overlap, S(0.0))));
    S reach = grown;
    for (int step = 0; step < 4; ++step) {
      const auto n = Law::template normal<S>(pair, max(reach, S(0.0)));
      const S has = stored(n);
      const auto over = (reach > S(0.0)) & (has > most * S(1.001));
      if (!any(over)) break;
      const S power_of = S(1.0) + n.stiffness * reach * reciprocal(max(n.force, S(1e-300)));  // U ~ δ^q
      const S share = max(most, S(1e-30) * has) * reciprocal(max(has, S(1e-300)));
      reach = select(over, reach * power(clamp(share, 1e-30, 1.0), reciprocal(max(power_of, S(1.0)))), reach);
    }
    return max(reach, m.g.overlap + min(m.approach.driven * S(options_.time), growth));
  }

  /// What a contact may grow to unnoticed; `most`: bound of the stiffer of its grains, for which it was allowed
  /// `before`. 0: it touches nothing till then.
  template <class S>
  S allowed(const Met<S>& m, const S& foreseen, const S& most, const S& before) const {
    const S overlap = max(m.g.overlap, S(0.0)), grown = m.g.overlap + m.approach.speed * S(options_.time);
    S reach = foreseen + S(options_.slack) * overlap;
    if (!(bound_.value > 0)) return select(grown > S(0.0), reach, S(0.0));
    const S stiffer = min(S(up_to * bound_.value) * reciprocal(max(most, S(1e-3 * bound_.value))), S(10.0));
    const S usual = clamp(S(2.0) * (stiffer - S(1.0)), 0, 1) * S(usual_);
    const S roomy = min(before * stiffer * stiffer, overlap * S(1 + most_slack) + S(usual_));
    reach = max(reach, max(roomy, usual));
    return select(grown + S(near) * usual > S(0.0), max(reach, S(0.0)), S(0.0));
  }

  void add_counted(CountedContact c, const Met<double>& m, const Vec3& from, std::vector<CountedContact>& found) const {
    Spring& s = c.spring;
    s.i = c.i, s.j = c.j, s.arm_i = m.g.arm_i, s.arm_j = m.g.arm_j, s.n = m.g.n;
    s.normal = c.counted.normal, s.tangential = c.counted.tangential;
    if (!acts(s)) return;
    c.motion = {c.counted.reach, turned(m, from), m.approach.turning * options_.time};
    found.push_back(c);
  }
  static double turned(const Met<double>& m, const Vec3& from) {
    return norm(from) > 0 ? norm(m.g.n - from) + direction_error : 0.0;
  }
  /// Whether it may grow past what it is allowed, or turn further than `leave`.
  bool is_beyond(const Met<double>& m, const Vec3& from, double may, double reach, double leave) const {
    const double off = turned(m, from);
    return reach > may * (1 + 1e-9) || (off > 0 && off + m.approach.turning * options_.time > leave);
  }

  Batch weights(std::size_t c, const Columns<Batch>& i, const Columns<Batch>& j, Batch kn, Batch kt) const {
    if (!(bound_.value > 0)) return Batch(1.0);
    const Batch tiny(1e-300), old = load_lanes(bound_.weight.data() + c);
    const auto centred = [&](Batch a_i, Batch a_j) {
      return clamp(sqrt(a_j * i.y / max(a_i * j.y, tiny)), 1 / widest, widest);
    };
    const Batch now = centred(max(kn * i.z, kt * i.w), max(kn * j.z, kt * j.w));
    return select(old > Batch(0.0), sqrt(old * now), centred(i.z, j.z));
  }

  static void store(std::size_t c, const Eight& e, Pressed& out) {
    for (std::size_t k = 0; k < lanes; ++k) {
      Spring& s = out.network.springs[c + k];
      s.arm_i = e.m.g.arm_i[k], s.arm_j = e.m.g.arm_j[k], s.normal = e.kn[k], s.tangential = e.kt[k];
      s.n = {e.m.g.n.x[k], e.m.g.n.y[k], e.m.g.n.z[k]};
      out.motion[c + k] = {e.reach[k], direction_error, e.turning[k]};
    }
  }

  /// By how much stiffer a pair counts.
  double give(std::size_t c) const {
    return !yields_.empty() && (yields_[state_.contacts.i[c]] | yields_[state_.contacts.j[c]]) ? yielding : 1;
  }

  void set_couples(std::size_t at, const Counted& c, Pressed& out) const {
    const Spring& s = out.network.springs[at];
    if (out.couples == 0 || s.i == s.j) return;
    const auto put = [&](std::size_t place) {
      Spring& couple = out.network.springs[place];
      couple.normal = c.twisting, couple.tangential = c.rolling, couple.n = s.n;
      out.motion[place] = out.motion[at];
    };
    put(out.couples + at);
    if (s.j != no_index) put(2 * out.couples + at);
  }
  template <class History>
  Counted counted(const Pair<double>& pair, double reach, double inverse_mass, double give,
                  const History& stored) const {
    Counted c;
    NormalResponse<double> n{};
    double rolling = 0, twisting = 0;
    if constexpr (HasCouples<Law>) {
      ContactHistory<Law, double> history{};
      if (state_.contacts.history_vectors > 0)
        for (std::size_t h = 0; h < history.size(); ++h) history[h] = stored(h);
      bool acts = reach > 0;
      if constexpr (HasBonds<Law>) acts = acts || history[Law::bond_value] > 0;
      if (acts) {
        const Standing s = Law::at_rest(pair, reach, history);
        n = s.normal, rolling = s.rolling, twisting = s.twisting;
      }
      if (state_.contacts.history_vectors == 0) n.tangential = rolling = twisting = 0;
    } else if (reach > 0) {
      n = response<double>(pair, reach);
    }
    c.normal = give * damped(n.stiffness, inverse_mass, damping_.normal_ratio);
    c.tangential = give * damped(n.tangential, inverse_mass, damping_.shear_ratio);
    c.rolling = 2 * give * damped(rolling, inverse_mass, 0), c.twisting = 2 * give * damped(twisting, inverse_mass, 0);
    c.reach = std::max(reach, 0.0);
    return c;
  }
  Counted counted(std::size_t c, const Met<double>& m, double reach) const {
    return counted(pair<double>(c, m), reach, m.inverse_mass, give(c),
                   [&](std::size_t h) { return state_.contacts.history_at(c, h); });
  }
  Counted counted_wall(std::size_t w, const Met<double>& m, double reach) const {
    const auto& contact = state_.wall_contacts[w];
    return counted(wall_pair(w), reach, m.inverse_mass,
                   state_.bodies[state_.walls[contact.wall].body].yields ? yielding : 1.0,
                   [&](std::size_t h) { return contact.history[h]; });
  }

  const State& state_;
  const StandingBound& bound_;
  PressOptions options_;
  CommonMotion motion_;
  Arms arms_;
  std::size_t kinds_;
  std::vector<Constants<double>> constants_;
  DampingSpec damping_;
  std::vector<std::uint8_t> yields_;
  double usual_;
  std::vector<Quad> rows_;  ///< of grains: bound, room below sigma, what kn and kt are divided by
};

}  // namespace

double centred_weight(double a_i, double room_i, double a_j, double room_j) {
  const double t = std::sqrt((a_j * room_i) / (a_i * room_j));
  return std::isfinite(t) ? std::clamp(t, 1 / widest, widest) : 1.0;
}

double room_below(double sigma, double bound) { return std::max(nearest * sigma, sigma - bound); }

void lay_out(const Scene& scene, const State& state, Pressed& out) {
  const auto& list = state.contacts;
  out.network = bare_network(scene, state);
  auto& springs = out.network.springs;
  bool couples = false;
  with_law(scene.contact.law,
           [&]<class Law>(Law) { couples = HasCouples<Law> && state.grains.rotates() && list.history_vectors > 0; });
  const std::size_t contacts = list.size() + state.wall_contacts.size();
  springs.reserve(couples ? 3 * contacts : contacts);
  const auto add = [&](Index i, Index j, bool couple) {
    Spring s;
    s.i = i, s.j = j, s.couple = couple;
    springs.push_back(s);
  };
  for (std::size_t c = 0; c < list.size(); ++c) add(list.i[c], list.j[c], false);
  for (const auto& w : state.wall_contacts) add(w.grain, no_index, false);
  if (couples) {
    for (std::size_t c = 0; c < contacts; ++c) add(springs[c].i, no_index, true);
    for (std::size_t c = 0; c < list.size(); ++c) add(list.j[c], no_index, true);
  }
  out.couples = couples ? contacts : 0;
  out.weight.assign(springs.size(), 1.0);
  out.motion.assign(springs.size(), {});
}

void lay_out(const State& state, Look& out) {
  const auto& list = state.contacts;
  out.weight.resize(list.size());
  out.outran.assign(list.size() + state.wall_contacts.size(), 0);
  out.terms = 2 * out.outran.size();
  if (list.chunk_begin.empty())
    out.schedule = {};
  else
    make_schedule(out.schedule, state.grains.size(), Contacts::chunk, list.j, list.chunk_begin);
  // Rows of grains begin at zero in every look, those beyond are left at zero by each.
  out.rows.resize(std::max(out.schedule.rows(), state.grains.size()));
  out.scheduled = true;
}

void look_at_all(const Scene& scene, State& state, const PressOptions& options, Look& out) {
  StandingBound& bound = state.policy.bound;
  const auto& list = state.contacts;
  const Schedule& schedule = out.schedule;
  const auto grains = static_cast<std::ptrdiff_t>(state.grains.size());
  constexpr auto chunk = static_cast<std::ptrdiff_t>(Contacts::chunk);
  if (schedule.chunks() == 0) std::ranges::fill(out.rows, GrainSums{});
  with_law(scene.contact.law, [&]<class Law>(Law) {
    const Presser<Law> presser(scene, state, options, Scope::all, options.looked.empty() ? usual_overlap(bound) : 0.0);
    const auto pairs = [&](std::size_t k) {
      const auto first = static_cast<std::ptrdiff_t>(k) * chunk;
      std::fill(out.rows.begin() + first, out.rows.begin() + std::min(grains, first + chunk), GrainSums{});
      for (std::size_t c = list.chunk_begin[k]; c < list.chunk_begin[k + 1]; c += lanes) presser.add(c, bound, out);
    };
    const auto gather = [&](std::size_t k) {
      for (Index e = schedule.gather_begin[k]; e < schedule.gather_begin[k + 1]; ++e) {
        GrainSums &to = out.rows[schedule.gather_grain[e]], &from = out.rows[schedule.gather_row[e]];
        to.block.first += from.block.first, to.block.second += from.block.second, to.play += from.play;
        from = {};
      }
    };
#pragma omp parallel if (schedule.chunks() >= Contacts::worth_threads)
    if (schedule.chunks() > 0) run_chunks(schedule, pairs, gather);
    for (std::size_t w = 0; w < state.wall_contacts.size(); ++w) presser.add_wall(w, bound, out);
  });
}

void press_contacts(const Scene& scene, State& state, const PressOptions& options, Pressed& out) {
  StandingBound& bound = state.policy.bound;
  const auto& list = state.contacts;
  const auto& g = state.grains;
  for (std::size_t i = 0; i < g.size(); ++i)
    out.network.inverse_mass[i] = g.velocity[i].w, out.network.radius[i] = g.radius(i);
  if (g.rotates())
    for (std::size_t i = 0; i < g.size(); ++i) out.network.inverse_inertia[i] = g.spin[i].w;
  const bool warm = bound.value > 0;
  if (!warm) bound.overlap.assign(list.size(), 0.0), bound.weight.assign(list.size(), 0.0);
  bound.direction.resize(3 * list.size());
  bound.wall_overlap.resize(state.wall_contacts.size()), bound.wall_direction.resize(state.wall_contacts.size());
  with_law(scene.contact.law, [&]<class Law>(Law) {
    const Presser<Law> presser(scene, state, options, Scope::all, options.looked.empty() ? usual_overlap(bound) : 0.0);
    const std::size_t chunks = list.chunk_begin.empty() ? 0 : list.chunk_begin.size() - 1;
#pragma omp parallel for schedule(static) if (chunks >= Contacts::worth_threads)
    for (std::size_t k = 0; k < chunks; ++k)
      for (std::size_t c = list.chunk_begin[k]; c < list.chunk_begin[k + 1]; c += lanes) presser.press(c, bound, out);
    for (std::size_t w = 0; w < state.wall_contacts.size(); ++w) presser.press_wall(w, bound, out);
  });
}

std::vector<Beyond> look_beyond(const Scene& scene, const State& state, const ContactSelection& selection,
                                std::span<const double> turn, const PressOptions& options) {
  std::vector<Beyond> found;
  with_law(scene.contact.law, [&]<class Law>(Law) {
    const Presser<Law> presser(scene, state, options, Scope::some, usual_overlap(state.policy.bound));
    for (const std::size_t c : selection.grains) presser.look(c, turn, found);
    for (const std::size_t w : selection.walls) presser.look_wall(w, turn, found);
  });
  return found;
}

std::vector<CountedContact> counted_contacts(const Scene& scene, const State& state, const ContactSelection& selection,
                                             double time) {
  std::vector<CountedContact> found;
  with_law(scene.contact.law, [&]<class Law>(Law) {
    const Presser<Law> presser(scene, state, {time, 0}, Scope::some, 0);
    for (const std::size_t c : selection.grains) presser.count(c, found);
    for (const std::size_t w : selection.walls) presser.count_wall(w, found);
  });
  return found;
}

}  // namespace eg
