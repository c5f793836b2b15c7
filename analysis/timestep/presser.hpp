#pragma once
// One contact, or eight, as it may be until the next check: what it is allowed, and the spring that it then counts as.
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
#include "timestep/approach.hpp"
#include "timestep/look.hpp"
#include "timestep/pressed.hpp"

namespace eg {
namespace presser {

inline constexpr double most_slack = 2;  // by which an overlap may grow beyond what is foreseen, at most [-]
inline constexpr double up_to = 0.8;     // of the bound: what contacts are given of the room of their grains
inline constexpr double near = 0.5;      // of that, for pairs that do not touch yet, by which they count before they do
inline constexpr double widest = 100;    // weight
inline constexpr double nearest = 0.02;  // room of a grain below the bound, as the weights see it [of the bound]
inline constexpr std::size_t lanes = Contacts::lanes;

template <class S>
S clamp(const S& x, double low, double high) {
  return min(max(x, S(low)), S(high));
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

/// What is asked about all contacts alike.
template <class Law>
class Presser {
 public:
  Presser(const Scene& scene, const State& state, const PressOptions& options)
      : state_(state),
        bound_(state.policy.bound),
        options_(options),
        motion_(state),
        arms_(arms_of(scene)),
        kinds_(scene.materials.size()),
        constants_(pair_constants<Law>(scene.materials, friction_in_force(scene, state), scene.dimension)),
        damping_(damping_in_force(scene, state)),
        yields_(glued_that_yield(state)),
        usual_(bound_.value > 0 ? bound_.usual : 0.0) {}

  /// What is to be known of each grain before its contacts are taken eight at a time. Shared by the threads of a
  /// parallel region.
  void prepare(AlignedVector<Quad>& grains) {
    const bool warm = bound_.value > 0;
#pragma omp for schedule(static)
    for (std::size_t i = 0; i < grains.size(); ++i) {
      const Inertia inertia = inertia_of(state_.grains, static_cast<Index>(i));
      const double b = warm ? bound_.grain[i] : 0.0;
      grains[i] = {b, room_below(bound_.value, b), inertia.inverse_mass,
                   inertia.inverse_mass + inertia.inverse_inertia * inertia.radius * inertia.radius};
    }
#pragma omp single
    rows_ = grains;
  }

  /// Eight pairs, into the network.
  void press(std::size_t c, StandingBound& bound, Pressed& out) const {
    const Eight e = take(c, bound);
    store(c, e, out);
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
    out.motion[at] = {found.counted.reach, found.turning};
    set_couples(at, found.counted, out);
  }

  /// Eight pairs, into the sums of their grains, and into those of what they are allowed.
  void add(std::size_t c, StandingBound& bound, const Schedule& schedule, Look& out, AllowedSums& allowed) const {
    const Eight e = take(c, bound);
    allowed.reach = allowed.reach + e.reach;
    allowed.count = allowed.count + select(e.reach > Batch(0.0), Batch(1.0), Batch(0.0));
    const Batch zero(0.0), one(1.0);
    if (any(e.outran))
      for (std::size_t k = 0; k < lanes; ++k) out.outran[c + k] = lane(e.outran, k);
    else
      std::fill_n(out.outran.begin() + static_cast<std::ptrdiff_t>(c), lanes, std::uint8_t{0});
    const Mask counts = (e.kn > zero) | (e.kt > zero);
    store_lanes(bound.weight.data() + c, select(counts, e.weight, zero));
    if (!any(counts)) return;
    const EightContacts contacts = taken_in(e, counts);
    const Mask split = (e.most_i > zero) & (e.most_j > zero);
    const Batch w_i = select(split, one + e.weight, one), w_j = select(split, one + reciprocal(e.weight), one);
    const Index *i = state_.contacts.i.data() + c, *j = state_.contacts.j.data() + c,
                *target = schedule.target.data() + c;
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
    row.play += Double4{s.tangential * found.counted.reach, stretch * found.turning, s.tangential * found.turning, 0};
    add_couples(row, s.n, found.counted, found.turning);
  }

  /// Adds the contact, at what it is allowed, if it counts for anything.
  void count(std::size_t c, std::vector<CountedContact>& found) const {
    const auto m = met<double>(c);
    add_counted({state_.contacts.i[c], state_.contacts.j[c], c, {}, {}, counted(c, m, bound_.overlap[c])}, m, found);
  }
  void count_wall(std::size_t w, std::vector<CountedContact>& found) const {
    const auto m = met_wall(w);
    add_counted({state_.wall_contacts[w].grain, no_index, w, {}, {}, counted_wall(w, m, bound_.wall_overlap[w])}, m,
                found);
  }

  /// What a contact is to be allowed that has not been looked at [m].
  double allowance(std::size_t c) const {
    const auto m = met<double>(c);
    const double most = std::max(bound_.grain[state_.contacts.i[c]], bound_.grain[state_.contacts.j[c]]);
    return allowed(pair<double>(c, m), m, most, bound_.overlap[c]);
  }
  double wall_allowance(std::size_t w) const {
    return allowed(wall_pair(w), met_wall(w), bound_.grain[state_.wall_contacts[w].grain], bound_.wall_overlap[w]);
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
  EG_INLINE Eight take(std::size_t c, StandingBound& bound) const {
    const Index *i = state_.contacts.i.data() + c, *j = state_.contacts.j.data() + c;
    const Batch zero(0.0);
    Eight e;
    e.m = met<Batch>(c);
    const Columns<Batch> side_i = load_rows<Batch>(rows_.data(), i), side_j = load_rows<Batch>(rows_.data(), j);
    const auto pair = this->pair<Batch>(c, e.m);
    const Mask real = e.m.distance > Batch(1e-140);  // padding has no length
    const Batch before = select(real, max(load_lanes(bound.overlap.data() + c), zero), zero);
    e.reach = select(real, allowed(pair, e.m, max(side_i.x, side_j.x), before), zero);
    const NormalResponse<Batch> at = response(pair, e.reach);
    const Mask counts = e.reach > zero;
    e.kn = select(counts, damped(at.stiffness, e.m.inverse_mass, damping_.normal_ratio), zero);
    e.kt = select(counts, damped(at.tangential, e.m.inverse_mass, damping_.shear_ratio), zero);
    e.weight = weights(c, side_i, side_j, e.kn, e.kt);
    e.most_i = side_i.w, e.most_j = side_j.w;
    e.turning = e.m.approach.turning * Batch(options_.time);
    e.outran = real & (e.m.g.overlap > before);
    if (HasCouples<Law> || !yields_.empty()) correct(c, e);
    store_lanes(bound.overlap.data() + c, select(real, e.reach, Batch(INFINITY)));
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
    const double reach = allowed(wall_pair(w), m, rows_[state_.wall_contacts[w].grain].x, before);
    WallSpring found;
    found.counted = counted_wall(w, m, reach);
    found.turning = m.approach.turning * options_.time, found.outran = m.g.overlap > std::max(before, 0.0);
    Spring& s = found.spring;
    s.arm_i = m.g.arm_i, s.normal = found.counted.normal, s.tangential = found.counted.tangential, s.n = m.g.n;
    bound.wall_overlap[w] = found.counted.reach;
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
    transpose_columns({e.kt * e.reach, both * e.turning, e.kt * e.turning, zero}, out.play);
    return out;
  }
  /// A pair of a grain and its own image only turns: its ends move alike.
  static void add_own_image(GrainSums& row, const Eight& e, std::size_t k) {
    Spring s;
    s.arm_i = e.m.g.arm_i[k], s.arm_j = e.m.g.arm_j[k], s.tangential = e.kt[k];
    s.n = {e.m.g.n.x[k], e.m.g.n.y[k], e.m.g.n.z[k]};
    add_side(row.block, s, {.own_image = true}, 1);
    const double turn = 4 * e.kt[k] * e.m.radius_i[k] * e.m.radius_i[k];
    row.play += Double4{4 * e.kt[k] * e.reach[k], 0, 0, turn * e.turning[k]};
  }
  static void add_couples(GrainSums& row, const Vec3& n, const Counted& c, double turning) {
    if (c.twisting == 0 && c.rolling == 0) return;
    Spring s;
    s.normal = c.twisting, s.tangential = c.rolling, s.n = n;
    add_couple(row.block, s, 1);
    row.play += Double4{0, 0, 0, std::abs(c.twisting - c.rolling) * turning};
  }

  template <class S>
  EG_INLINE Met<S> met(std::size_t c) const {
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

  /// What a contact is to be allowed; `most`: bound of the stiffer of its grains, for which it was allowed `before`. 0:
  /// it touches nothing till then.
  template <class S>
  S allowed(const Pair<S>& pair, const Met<S>& m, const S& most, const S& before) const {
    const S overlap = max(m.g.overlap, S(0.0)), margin = S(options_.slack) * overlap,
            grown = m.g.overlap + m.approach.speed * S(options_.time);
    if (!(bound_.value > 0)) return select(grown > S(0.0), foreseen(pair, m) + margin, S(0.0));
    const S stiffer = min(S(up_to * bound_.value) * reciprocal(max(most, S(1e-3 * bound_.value))), S(10.0));
    const S usual = clamp(S(2.0) * (stiffer - S(1.0)), 0, 1) * S(usual_);
    const S roomy = max(min(before * stiffer * stiffer, overlap * S(1 + most_slack) + S(usual_)), usual);
    S reach = grown + margin;
    if (any(reach > roomy)) reach = foreseen(pair, m) + margin;  // which is not more
    return select(grown + S(near) * usual > S(0.0), max(max(reach, roomy), S(0.0)), S(0.0));
  }

  void add_counted(CountedContact c, const Met<double>& m, std::vector<CountedContact>& found) const {
    Spring& s = c.spring;
    s.i = c.i, s.j = c.j, s.arm_i = m.g.arm_i, s.arm_j = m.g.arm_j, s.n = m.g.n;
    s.normal = c.counted.normal, s.tangential = c.counted.tangential;
    if (!acts(s)) return;
    c.motion = {c.counted.reach, m.approach.turning * options_.time};
    found.push_back(c);
  }

  Batch weights(std::size_t c, const Columns<Batch>& i, const Columns<Batch>& j, Batch kn, Batch kt) const {
    if (!(bound_.value > 0)) return Batch(1.0);
    const Batch old = load_lanes(bound_.weight.data() + c);
    const auto centred = [&](Batch a_i, Batch a_j) {
      return clamp(root_of_ratio(a_j * i.y, a_i * j.y), 1 / widest, widest);
    };
    const Batch now = centred(max(kn * i.z, kt * i.w), max(kn * j.z, kt * j.w));
    return select(old > Batch(0.0), root(old * now), centred(i.z, j.z));
  }

  static void store(std::size_t c, const Eight& e, Pressed& out) {
    for (std::size_t k = 0; k < lanes; ++k) {
      Spring& s = out.network.springs[c + k];
      s.arm_i = e.m.g.arm_i[k], s.arm_j = e.m.g.arm_j[k], s.normal = e.kn[k], s.tangential = e.kt[k];
      s.n = {e.m.g.n.x[k], e.m.g.n.y[k], e.m.g.n.z[k]};
      out.motion[c + k] = {e.reach[k], e.turning[k]};
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
  std::span<const Quad> rows_;  ///< of grains: bound, room below sigma, what kn and kt are divided by
};

}  // namespace presser
}  // namespace eg
