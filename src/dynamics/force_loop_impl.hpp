#pragma once
// The force loop, once for every law and number type; included only by the files that instantiate it.
#include <algorithm>

#include "contact/lanes.hpp"
#include "dynamics/force_loop.hpp"
#include "state/wall_geometry.hpp"

namespace eg {

template <class Law, bool rotation>
class ForceLoopOf final : public ForceLoop {
 public:
  using Table = typename Law::template Constants<double>;
  static constexpr std::size_t stride = rotation ? 2 : 1;  // quads a row of forces
  static constexpr bool couples = rotation && HasCouples<Law>;
  struct Nothing {};
  template <class T>
  using IfCouples = std::conditional_t<couples, T, Nothing>;

  std::size_t history_size() const override { return eg::history_size<Law>; }
  std::size_t history_vectors() const override { return Law::history_vectors; }
  bool has_moments() const override { return rotation; }

  void set_materials(const std::vector<Material>& materials, const std::vector<double>& friction,
                     int dimension) override {
    kinds_ = materials.size();
    constants_ = pair_constants<Law>(materials, friction, dimension);
  }

  Tally contacts(State& state, ForceWorkspace& work, double dt, const ForceOptions& options,
                 const AfterChunk& after) const override {
    const std::size_t chunks = work.schedule.chunks();
    work.clean = false;
    for (std::size_t c = 0; c < Cell::images; ++c) work.shift[c].set(state.cell.shift(static_cast<std::uint8_t>(c)));
#pragma omp parallel if (chunks >= Contacts::worth_threads)
    run_chunks(
        work.schedule, [&](std::size_t k) { work.tally[k] = run_chunk(state, work, k, dt, options); },
        [&](std::size_t k) {
          if (after) after(k);
        });
    Tally total;
    for (std::size_t k = 0; k < chunks; ++k) total += work.tally[k];
    return total;
  }

  Tally walls(State& state, ForceWorkspace& work, double dt, const ForceOptions& options) const override;

  std::size_t bond_value() const override {
    if constexpr (HasBonds<Law>) return Law::bond_value;
    return 0;
  }

  void bond(Contacts& list, std::size_t c, double overlap) const override {
    if constexpr (HasBonds<Law>) {
      ContactHistory<Law, double> history;
      for (std::size_t h = 0; h < history.size(); ++h) history[h] = list.history_at(c, h);
      Law::bond(history, overlap);
      for (std::size_t h = 0; h < history.size(); ++h) list.history_at(c, h) = history[h];
    }
  }

 private:
  /// Number type and damping are settled here, outside the loop over contacts.
  Tally run_chunk(State& state, ForceWorkspace& work, std::size_t k, double dt, const ForceOptions& options) const {
    const bool damped = options.normal_ratio > 0 || options.shear_ratio > 0;
    if (options.scalar)
      return damped ? chunk<double, true>(state, work, k, dt, options)
                    : chunk<double, false>(state, work, k, dt, options);
    return damped ? chunk<Batch, true>(state, work, k, dt, options) : chunk<Batch, false>(state, work, k, dt, options);
  }

  template <class S>
  struct Sums {
    Mat<S> virial;
    S force = S(0.0), touching = S(0.0), stiffness = S(0.0), shear_work = S(0.0), friction = S(0.0), viscous = S(0.0);
    S pulled = S(0.0), cut = S(0.0);
  };

  /// What the law gives back for eight (or one) contacts.
  template <class S>
  struct Outgoing {
    Vec<S> force, moment;
    S arm_i, arm_j;
    [[no_unique_address]] IfCouples<Vec<S>> couple;
  };

  /// Contacts go through in blocks, each in three passes: gather, law, scatter. One pass over all three would be a
  /// chain of operations too long for the processor to overlap with the next one.
  template <class S, bool damped>
  Tally chunk(State& state, ForceWorkspace& work, std::size_t k, double dt, const ForceOptions& options) const {
    constexpr std::size_t lanes = lanes_of<S>, block = lanes == 1 ? 1 : 8;
    Contacts& list = state.contacts;
    Quad* rows = work.rows.data();
    const Index* target = work.schedule.target.data();
    const bool prefetch = state.grains.size() > 20000;  // fewer stay in the second-level cache by themselves
    const bool images = !list.image.empty();
    const Grains& g = state.grains;
    const auto uniform = broadcast_struct<typename Law::template Constants<S>, S>(constants_.front());
    const Mat<S> affine = broadcast<S>(state.cell.rate);
    Sums<S> sums;
    std::array<BothSides<S>, block> in;
    std::array<Outgoing<S>, block> out;

    const std::size_t end = list.chunk_begin[k + 1];
    for (std::size_t c = list.chunk_begin[k]; c < end; c += block * lanes) {
      const std::size_t count = std::min(block, (end - c) / lanes);
      if (prefetch && c + block * lanes < end)
        fetch(state, work, c + block * lanes, std::min(end, c + 2 * block * lanes));
      for (std::size_t b = 0; b < count; ++b) {
        const std::size_t at = c + b * lanes;
        load_sides<rotation, S>(in[b], g.position.data(), g.velocity.data(), g.spin.data(), list.i.data() + at,
                                list.j.data() + at, work.shift.data(), images ? list.image.data() + at : nullptr);
      }
      for (std::size_t b = 0; b < count; ++b)
        respond<S, damped>(out[b], in[b], affine, uniform, state, c + b * lanes, dt, options, sums);
      for (std::size_t b = 0; b < count; ++b) {
        const Index *i = list.i.data() + c + b * lanes, *j = target + c + b * lanes;
        if constexpr (couples)
          add_contact_with_couple<S>(rows, i, j, out[b].force, out[b].moment, out[b].arm_i, out[b].arm_j,
                                     out[b].couple);
        else
          add_contact<stride, S>(rows, i, j, out[b].force, out[b].moment, lanes_at(out[b].arm_i),
                                 lanes_at(out[b].arm_j));
      }
    }
    return finish(sums);
  }

  static void fetch(const State& state, const ForceWorkspace& work, std::size_t first, std::size_t end) {
    for (std::size_t c = first; c < end; ++c) {
      const Index j = state.contacts.j[c];
      __builtin_prefetch(&state.grains.position[j]), __builtin_prefetch(&state.grains.velocity[j]);
      if constexpr (rotation) __builtin_prefetch(&state.grains.spin[j]);
      __builtin_prefetch(&work.rows[stride * work.schedule.target[c]], 1);
    }
  }

  template <class S, bool damped>
  EG_INLINE void respond(Outgoing<S>& out, const BothSides<S>& in, const Mat<S>& affine,
                         const typename Law::template Constants<S>& uniform, State& state, std::size_t c, double dt,
                         const ForceOptions& options, Sums<S>& sums) const {
    Contacts& list = state.contacts;
    const Vec<S> branch = xyz(in.branch);
    const S sum = in.branch.w, ri = in.radius_i, rj = sum - ri, inverse_mass = in.velocity.w;
    const auto g = grain_grain(branch, ri, sum, options.arms);
    const auto touching = (g.overlap > S(0.0)) & (dot(branch, branch) > S(0.0));  // padding has branch 0
    Motion<S> motion;
    motion.translation = (xyz(in.velocity) + affine * branch) * S(dt);
    if constexpr (rotation) {
      const Vec<S> wi = xyz(in.spin_i), wj = xyz(in.spin_j);
      motion.turn = (wi + wj) * S(dt);
      motion.roll = wi * (ri * S(dt)) + wj * (rj * S(dt));
      if constexpr (couples) motion.bend = (wj - wi) * S(dt);
    }
    const auto inc = increment<rotation>(g, motion);

    ContactHistory<Law, S> history;
    double* stored =
        list.history.data() + (c / Contacts::lanes * list.history_size) * Contacts::lanes + c % Contacts::lanes;
    for (std::size_t h = 0; h < history.size(); ++h) history[h] = load_values<S>(stored + h * Contacts::lanes);
    Dashpot<S> dashpot;
    if constexpr (damped)
      dashpot = {S(options.normal_ratio), S(options.shear_ratio), inverse_mass, S(dt > 0 ? 1 / dt : 0)};
    auto pair =
        Law::template pair<S>(!state.grains.material.empty() ? constants<S>(state, c) : uniform, grain_sizes(ri, rj));
    if (Law::history_vectors > 0 && !list.friction.empty())
      pair.friction = pair.friction * load_values<S>(list.friction.data() + c);
    const ContactForce<S> f = interact<Law, damped>(pair, g, inc, touching, history, dashpot);
    for (std::size_t h = 0; h < history.size(); ++h) store_values(stored + h * Contacts::lanes, history[h]);
    put(out.force, f.on_j);
    if constexpr (rotation) put(out.moment, f.moment), out.arm_i = g.arm_i, out.arm_j = g.arm_j;
    if constexpr (couples) put(out.couple, f.couple);
    if constexpr (HasBonds<Law>) sums.pulled = sums.pulled + f.law.pulled, sums.cut = sums.cut + f.law.cut;

    if (options.tally == TallyLevel::none) return;
    add_stress(sums, branch, f, touching);
    if (options.tally == TallyLevel::stress) return;
    add_works(sums, inc, f, touching);
    const S curvature = reciprocal(max(sum - g.overlap, S(1e-300)));
    add_turning(sums, f, g, motion, inc, curvature, options.arms);
    if (options.viscous_history)
      sums.viscous = sums.viscous + viscous_work(stored + history.size() * Contacts::lanes, Contacts::lanes, g, motion,
                                                 inc, f, curvature, options.arms);
  }

  /// Component by component: g++ copies the struct in halves, through memory.
  template <class S>
  EG_INLINE static void put(Vec<S>& to, const Vec<S>& from) {
    to.x = from.x, to.y = from.y, to.z = from.z;
  }

  template <class S>
  EG_INLINE typename Law::template Constants<S> constants(const State& state, std::size_t c) const {
    using Out = typename Law::template Constants<S>;
    const auto& material = state.grains.material;
    return gather_struct<Out, S>(constants_.data(), [&](std::size_t l) {
      return material[state.contacts.i[c + l]] * kinds_ + material[state.contacts.j[c + l]];
    });
  }

  template <class S, class M>
  EG_INLINE static void add_stress(Sums<S>& sums, const Vec<S>& branch, const ContactForce<S>& f, M touching) {
    sums.virial += outer(f.on_j, branch);
    sums.stiffness = sums.stiffness + select(touching, f.law.normal.stiffness * dot(branch, branch), S(0.0));
  }

  template <class S, class M>
  EG_INLINE static void add_works(Sums<S>& sums, const Increment<S>& inc, const ContactForce<S>& f, M touching) {
    sums.force = sums.force + root(dot(f.on_j, f.on_j));
    sums.touching = sums.touching + select(touching, S(1.0), S(0.0));
    if constexpr (HasCouples<Law>) {
      sums.shear_work = sums.shear_work + f.law.work, sums.friction = sums.friction + f.law.loss;
    } else if constexpr (Law::history_vectors > 0) {
      const Vec<S> mean = (f.law.shear + f.before.shear) * S(0.5);  // trapezoidal rule over the increment
      sums.shear_work = sums.shear_work + dot(mean, inc.slip);
      const S slid = dot(mean, f.law.unslipped - f.law.shear);
      const S kt = f.law.normal.tangential;
      sums.friction = sums.friction + select(touching & (kt > S(0.0)), slid / max(kt, S(1e-300)), S(0.0)) + f.law.loss;
    }
  }

  template <class S>
  EG_INLINE static void add_turning(Sums<S>& sums, const ContactForce<S>& f, const Geometry<S>& g,
                                    const Motion<S>& motion, const Increment<S>& inc, const S& curvature, Arms arms) {
    if constexpr (Law::history_vectors > 0)
      sums.shear_work =
          sums.shear_work + S(0.5) * work_of_turning<rotation, couples>(f.before, g, motion, inc, curvature, arms);
  }

  /// Work on the dashpots by the trapezoidal rule; their last force is kept at `stored` (three values, `stride` apart).
  template <class S>
  EG_INLINE static S viscous_work(double* stored, std::size_t stride, const Geometry<S>& g, const Motion<S>& motion,
                                  const Increment<S>& inc, const ContactForce<S>& f, const S& curvature, Arms arms) {
    const Vec<S> old{load_values<S>(stored), load_values<S>(stored + stride), load_values<S>(stored + 2 * stride)};
    store_values(stored, f.dashpot.x), store_values(stored + stride, f.dashpot.y),
        store_values(stored + 2 * stride, f.dashpot.z);
    const Vec<S> mean = (old + f.dashpot) * S(0.5);
    const S work = dot(mean, g.n) * inc.approach - dot(mean, inc.slip);
    if constexpr (rotation) return work - S(0.5) * dot(old, change_of_roll(g, motion, inc, curvature, arms));
    return work;
  }

  template <class S>
  static Mat<S> broadcast(const Mat3& m) {
    Mat<S> b;
    for (std::size_t k = 0; k < 9; ++k) b.a[k] = S(m.a[k]);
    return b;
  }
  static double total(double s) { return s; }
  static double total(Batch s) { return sum(s); }
  template <class S>
  static Tally finish(const Sums<S>& s) {
    Tally t;
    for (std::size_t k = 0; k < 9; ++k) t.virial.a[k] = total(s.virial.a[k]);
    t.force_sum = total(s.force), t.touching = total(s.touching);
    t.stiffness_sum = total(s.stiffness), t.shear_work = total(s.shear_work);
    t.friction = total(s.friction), t.viscous = total(s.viscous);
    t.pulled = total(s.pulled), t.cut = total(s.cut);
    return t;
  }

  std::size_t kinds_ = 0;
  std::vector<Table> constants_;
};

template <class Law, bool rotation>
Tally ForceLoopOf<Law, rotation>::walls(State& state, ForceWorkspace& work, double dt,
                                        const ForceOptions& options) const {
  Tally tally;
  for (auto& c : state.wall_contacts) {
    const Wall& wall = state.walls[c.wall];
    Body& body = state.bodies[wall.body];
    const Quad& p = state.grains.position[c.grain];
    const Quad& v = state.grains.velocity[c.grain];
    const auto g = grain_wall<double>(state, wall, p.vec(), p.w, options.arms);
    const Vec3 outward = radial(wall, p.vec());
    const Vec3 turned = rotation ? state.grains.spin[c.grain].vec() * dt : Vec3{};
    const auto motion = wall_motion<double>((body.velocity + outward * body.opening - v.vec()) * dt, turned, p.w);
    const auto inc = increment<rotation>(g, motion);
    const auto& constants = constants_[state.grains.material_of(c.grain) * kinds_ + wall.material];
    auto pair = Law::template pair<double>(constants, wall_sizes(p.w));
    pair.friction *= c.friction;
    ContactHistory<Law, double> history;
    std::copy_n(c.history.begin(), history.size(), history.begin());
    const Dashpot<double> dashpot{options.normal_ratio, options.shear_ratio, v.w, dt > 0 ? 1 / dt : 0};
    const auto f = interact<Law, true>(pair, g, inc, g.overlap > 0, history, dashpot);
    std::copy_n(history.begin(), history.size(), c.history.begin());

    Quad* row = work.rows.data() + work.stride * c.grain;
    row[0].set(row[0].vec() - f.on_j);
    if constexpr (rotation) row[1].set(row[1].vec() + f.moment * g.arm_i + f.couple);
    body.force += f.on_j;
    body.spread += dot(f.on_j, outward);
    if (g.overlap > 0) {
      body.magnitude += norm(f.on_j);
      body.stiffness += std::max(f.law.normal.stiffness, f.law.normal.tangential);
    }
    if (options.tally == TallyLevel::none) continue;
    Sums<double> sums;
    add_stress(sums, g.n * (p.w - g.overlap), f, g.overlap > 0);
    if (options.tally != TallyLevel::works) {
      tally += finish(sums);
      continue;
    }
    add_works(sums, inc, f, g.overlap > 0);
    add_turning(sums, f, g, motion, inc, 0.0, options.arms);
    if (options.viscous_history)
      sums.viscous = viscous_work<double>(c.history.data() + history.size(), 1, g, motion, inc, f, 0.0, options.arms);
    tally += finish(sums);
  }
  return tally;
}

/// The instantiations a law needs; one source file a law calls it.
template <class Law>
std::unique_ptr<ForceLoop> make_force_loop_of(bool frictionless, bool rotation) {
  if constexpr (!HasCouples<Law>)
    if (frictionless) return std::make_unique<ForceLoopOf<Frictionless<Law>, false>>();
  if (rotation) return std::make_unique<ForceLoopOf<Law, true>>();
  return std::make_unique<ForceLoopOf<Law, false>>();
}

}  // namespace eg
