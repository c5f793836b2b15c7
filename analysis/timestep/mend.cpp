#include "timestep/mend.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "timestep/block_ranges.hpp"
#include "timestep/pressed.hpp"
#include "timestep/some_grains.hpp"

namespace eg {
namespace {

constexpr double widest = 1000;  // weight
constexpr double warm = 0.85;    // of the largest bound: grains that sweeps work on
constexpr double tight = 0.97;   // of it: grains whose bound is to be exact
constexpr int most_sweeps = 5;
constexpr std::size_t patched = 64;  // one in so many grains, and 40, are few

/// Grains that do not fit and those that they touch, with all contacts of either.
class Patch {
 public:
  Patch(const Scene& scene, const State& state, const std::vector<Index>& grains, double time, bool neighbours)
      : state_(state), some_(state) {
    for (const Index g : grains) some_.take_in(g);
    inner_ = some_.grains().size();
    std::vector<std::size_t> pairs = some_.pairs();
    if (neighbours) {
      for (const std::size_t c : pairs)
        if (state.policy.bound.weight[c] > 0) some_.take_in(state.contacts.i[c]), some_.take_in(state.contacts.j[c]);
      inner_ = some_.grains().size();
      pairs = some_.pairs();
    }
    contacts_ = counted_contacts(scene, state, {pairs, some_.walls()}, time);
    make_network();
  }

  /// Whether all inner grains stay below the bound, by the weights that they have or what so many sweeps make of them.
  bool fits(int most_sweeps) { return sweep(most_sweeps, state_.policy.bound.value) <= state_.policy.bound.value; }

  /// Brings the largest bound of an inner grain down to this, or what it comes to at best [1/s²].
  double sweep(int most_sweeps, double target) {
    const Sides sides(network_);
    BlockRanges ranges(sides.size());
    std::vector<Index> inner(inner_);
    std::iota(inner.begin(), inner.end(), Index{0});
    double least = INFINITY;
    for (std::vector<double> t = weight_;; --most_sweeps) {
      block_ranges(sides, t, inner, ranges);
      std::vector<double> bounds = plays_of(sides, t, motion_);
      double most = 0;
      for (const Index g : inner) most = std::max(most, bounds[g] += ranges.high[g]);
      for (const Index g : inner)
        if (bounds[g] > std::max(target, tight * most))
          bounds[g] += std::min(0.0, block_upper_bound(scalar_block(sides, t, g), sides.of(g).size()) - ranges.high[g]);
      most = *std::max_element(bounds.begin(), bounds.begin() + static_cast<std::ptrdiff_t>(inner_));
      const auto open = [&](Index g) { return bounds[g] > std::max(target, warm * most); };
      if (most < least) least = most, weight_ = t, bounds_ = bounds;
      if (least <= target || most_sweeps <= 0) return least;
      for (std::size_t c = 0; c < contacts_.size(); ++c) {
        const Spring& s = network_.springs[c];
        if (!sides.is_split(c) || s.i >= inner_ || s.j >= inner_ || !(open(s.i) || open(s.j))) continue;
        const double next = t[c] * (ranges.high[s.j] / ranges.high[s.i]);
        if (std::isfinite(next)) t[c] = std::clamp(next, 1 / widest, widest);
      }
    }
  }

  void keep(StandingBound& bound) const {
    for (std::size_t c = 0; c < contacts_.size(); ++c) {
      const CountedContact& contact = contacts_[c];
      if (contact.j != no_index && is_inner(contact.i) && is_inner(contact.j)) bound.weight[contact.entry] = weight_[c];
    }
    for (std::size_t g = 0; g < inner_; ++g) bound.grain[some_.grains()[g]] = bounds_[g];
  }

 private:
  bool is_inner(Index g) const { return some_.number_of(g) < inner_; }

  void make_network() {
    for (const CountedContact& c : contacts_) {
      some_.take_in(c.i);
      if (c.j != no_index) some_.take_in(c.j);
    }
    network_ = some_.network();
    const auto add = [&](Spring s, const SpringMotion& motion, double weight) {
      s.i = some_.number_of(s.i);
      if (s.j != no_index) s.j = some_.number_of(s.j);
      network_.springs.push_back(s), motion_.push_back(motion), weight_.push_back(weight);
    };
    for (const CountedContact& c : contacts_) {
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
  SomeGrains some_;        ///< the inner ones first
  std::size_t inner_ = 0;  ///< how many of them
  std::vector<CountedContact> contacts_;
  Network network_;  ///< a spring a contact, then couples
  std::vector<SpringMotion> motion_;
  std::vector<double> weight_;
  std::vector<double> bounds_;
};

}  // namespace

bool are_few(const State& state, std::size_t grains) { return grains * patched <= state.grains.size() + patched * 40; }

bool mend(const Scene& scene, State& state, const std::vector<Index>& grains, double time) {
  for (const bool neighbours : {false, true}) {
    Patch patch(scene, state, grains, time, neighbours);
    if (!patch.fits(neighbours ? most_sweeps : 0)) continue;
    patch.keep(state.policy.bound);
    return true;
  }
  return false;
}

void ease(const Scene& scene, State& state, double time) {
  StandingBound& bound = state.policy.bound;
  const double most = bound.grain.empty() ? 0.0 : *std::max_element(bound.grain.begin(), bound.grain.end());
  for (const double share : {0.8, 0.9, 0.95}) {
    std::vector<Index> stiff;
    for (Index g = 0; g < bound.grain.size(); ++g)
      if (bound.grain[g] > share * most) stiff.push_back(g);
    if (stiff.empty()) return;  // nothing touches
    if (!are_few(state, stiff.size())) continue;
    Patch patch(scene, state, stiff, time, true);
    patch.sweep(most_sweeps, share * most);
    patch.keep(bound);
    return;
  }
}

}  // namespace eg
