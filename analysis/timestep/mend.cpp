#include "timestep/mend.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "timestep/outgrown.hpp"
#include "timestep/pressed.hpp"

namespace eg {
namespace {

constexpr double widest = 1000;  // weight

/// Grains that do not fit and those that they touch, with all contacts of either.
class Patch {
 public:
  Patch(const Scene& scene, const State& state, const std::vector<Index>& grains, double time, bool neighbours)
      : state_(state), local_(state.grains.size(), no_index) {
    for (const Index g : grains) take_in(g);
    inner_ = grains_.size();
    std::vector<std::size_t> pairs = pairs_of_inner(), walls;
    if (neighbours) {
      for (const std::size_t c : pairs)
        if (state.policy.bound.weight[c] > 0) take_in(state.contacts.i[c]), take_in(state.contacts.j[c]);
      inner_ = grains_.size();
      pairs = pairs_of_inner();
    }
    for (std::size_t w = 0; w < state.wall_contacts.size(); ++w)
      if (is_inner(state.wall_contacts[w].grain)) walls.push_back(w);
    contacts_ = counted_contacts(scene, state, {pairs, walls}, time);
    make_network();
  }

  /// Whether all inner grains stay below the bound, by the weights that they have or what so many sweeps make of them.
  bool fits(int most_sweeps) {
    const StandingBound& bound = state_.policy.bound;
    const Sides sides(network_);
    ranges_ = BlockRanges(sides.size());
    std::vector<Index> inner(inner_);
    std::iota(inner.begin(), inner.end(), Index{0});
    for (int sweep = 0;; ++sweep) {
      block_ranges(sides, weight_, inner, ranges_);
      plays_ = plays_of(sides, weight_, motion_);
      std::vector<bool> open(sides.size(), false);
      bool all = true;
      for (const Index g : inner) {
        const double most = most_below(bound.value, plays_[g]);
        if (ranges_.high[g] < most || block_is_below(scalar_block(sides, weight_, g), sides.of(g).size(), most))
          continue;
        open[g] = true, all = false;
      }
      if (all || sweep == most_sweeps) return all;
      for (std::size_t c = 0; c < contacts_.size(); ++c) {
        const Spring& s = network_.springs[c];
        if (!sides.is_split(c) || s.i >= inner_ || s.j >= inner_ || !(open[s.i] || open[s.j])) continue;
        const double next = weight_[c] * (ranges_.high[s.j] / ranges_.high[s.i]);
        if (std::isfinite(next)) weight_[c] = std::clamp(next, 1 / widest, widest);
      }
    }
  }

  void keep(StandingBound& bound) const {
    for (std::size_t c = 0; c < contacts_.size(); ++c) {
      const CountedContact& contact = contacts_[c];
      if (contact.j == no_index) {
        bound.wall_direction[contact.entry] = contact.spring.n;
      } else if (is_inner(contact.i) && is_inner(contact.j)) {
        bound.weight[contact.entry] = weight_[c];
        set_direction(bound, contact.entry, contact.spring.n);
      }
    }
    for (std::size_t g = 0; g < inner_; ++g) keep_grain(bound, grains_[g], ranges_.high[g], plays_[g]);
  }

 private:
  std::vector<std::size_t> pairs_of_inner() const {
    const auto& list = state_.contacts;
    std::vector<std::uint8_t> marked(local_.size());
    for (std::size_t g = 0; g < local_.size(); ++g) marked[g] = local_[g] < inner_;
    std::vector<std::size_t> pairs;
    for (std::size_t c = 0; c < list.size(); ++c)
      if ((marked[list.i[c]] | marked[list.j[c]]) && !list.is_padding(c)) pairs.push_back(c);
    return pairs;
  }
  bool is_inner(Index g) const { return local_[g] < inner_; }
  void take_in(Index g) {
    if (local_[g] != no_index) return;
    local_[g] = static_cast<Index>(grains_.size());
    grains_.push_back(g);
  }

  void make_network() {
    for (const CountedContact& c : contacts_) {
      take_in(c.i);
      if (c.j != no_index) take_in(c.j);
    }
    network_.dimension = state_.dimension, network_.rotation = state_.grains.rotates();
    for (const Index g : grains_) {
      const Inertia inertia = inertia_of(state_.grains, g);
      network_.inverse_mass.push_back(inertia.inverse_mass), network_.radius.push_back(inertia.radius);
      if (network_.rotation) network_.inverse_inertia.push_back(inertia.inverse_inertia);
    }
    const auto add = [&](Spring s, const SpringMotion& motion, double weight) {
      s.i = local_[s.i];
      if (s.j != no_index) s.j = local_[s.j];
      network_.springs.push_back(s), motion_.push_back(motion), weight_.push_back(weight);
    };
    for (CountedContact& c : contacts_) {
      const bool whole = c.j == no_index || (is_inner(c.i) && is_inner(c.j));
      if (whole) c.motion.turned = direction_error;  // it will count with its present direction
      const double t = c.j == no_index ? 0 : state_.policy.bound.weight[c.entry];
      add(c.spring, c.motion, t > 0 ? t : 1.0);
    }
    for (const CountedContact& c : contacts_) {
      if (c.counted.twisting == 0 && c.counted.rolling == 0) continue;
      for (const Index g : {c.i, c.j}) {
        if (g == no_index || (g == c.j && c.i == c.j)) continue;
        Spring s;
        s.i = g, s.j = no_index, s.couple = true, s.n = c.spring.n;
        s.normal = c.counted.twisting, s.tangential = c.counted.rolling;
        add(s, c.motion, 1.0);
      }
    }
  }

  const State& state_;
  std::vector<Index> local_;   ///< of every grain: its place in the patch
  std::vector<Index> grains_;  ///< the inner ones first
  std::size_t inner_ = 0;
  std::vector<CountedContact> contacts_;
  Network network_;  ///< a spring a contact, then couples
  std::vector<SpringMotion> motion_;
  std::vector<double> weight_;
  BlockRanges ranges_{0};
  std::vector<GrainPlay> plays_;
};

}  // namespace

bool mend(const Scene& scene, State& state, const std::vector<Index>& grains, double time) {
  for (const bool neighbours : {false, true}) {
    Patch patch(scene, state, grains, time, neighbours);
    if (!patch.fits(neighbours ? 6 : 0)) continue;
    patch.keep(state.policy.bound);
    return true;
  }
  return false;
}

}  // namespace eg
