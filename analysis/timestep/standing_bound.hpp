#pragma once
// A bound of λmax that stands while the packing moves on, and the check that it still does.
//
// A renewal bounds the S_i of contact splitting with every pair at the overlap that it is allowed, somewhat more than
// it has. A check looks at all listed pairs at the overlap and the direction that they can reach until the next one.
// Pairs within what they are allowed change nothing. When few are not, each adds at most
// (1 + t^±1) max(Δkn/m, Δkt (1/m + R²/I)) to λmax(S_i) of its grains (Weyl 1912), and something for its turn; a grain
// that this takes past the bound is worked out afresh with its own contacts (mend.hpp). When many pairs are not, or
// grains cannot be mended, all S_i are. A spring of couples is counted as one of twice its stiffness against the ground
// on each of its grains, which is not less. Proof: certificates.md.
#include <optional>

#include "timestep/pressed.hpp"
#include "timestep/scalar_weights.hpp"

namespace eg {

struct RenewOptions {
  double time = 0;     ///< until the next check [s]
  double slack = 0;    ///< by which every overlap may grow before it counts as outgrown [-]
  double room = 0;     ///< by which the bound is to exceed what the packing needs now [-]
  double floor = 0;    ///< least value of the bound [1/s²]
  double step = 0;     ///< at which dashpots are counted [s] (damped_network)
  bool afresh = true;  ///< false: a check that failed just now has looked at all contacts, for the same time and step
};

struct StandingCheck {
  bool stands = true;
  std::size_t outgrown = 0;  ///< contacts beyond what they are allowed, in overlap or direction
  std::size_t examined = 0;  ///< grains worked out afresh
  bool outrun = false;       ///< it fails by a grain with a contact that had gone beyond what it was allowed before
};

/// Keeps state.policy.bound, which is all that it remembers but for scratch and the keys of the lists.
class StandingBounds {
 public:
  explicit StandingBounds(const Scene& scene) : scene_(scene) {}

  /// Takes note of the lists that the bound is for.
  void remember(const State& state);
  /// A new bound, warm-started from the old one if that has a meaning yet; returns a lower bound of λmax of the packing
  /// as it is [1/s²].
  double renew(State& state, const RenewOptions& options);
  /// Carries the bound over to the present lists. False when the grains have been sorted anew: it has no meaning then.
  bool follow(State& state);
  /// Whether λmax ≤ bound.value for the `time` to come [s]. Pairs that outgrow what they are allowed are allowed more,
  /// with the slack [-], as long as their grains stay below the bound.
  StandingCheck check(State& state, double time, double slack);
  /// After follow(), for what is left of the time that the last check was for: whether the new pairs leave the bound as
  /// it is. If not, all are to be checked.
  bool check_fresh(State& state, double time, double slack);

 private:
  /// Allows those of a few contacts more that may need it; false when there are too many, or a grain has no room left.
  bool allow_more(State& state, const ContactSelection& selection, double time, double slack);
  /// Allows such a contact more, and adds what that may add to λmax(S_i) of its grains; whether they stay below. Those
  /// that do not are added to `open`.
  bool add_excess(State& state, const Beyond& contact, std::vector<Index>& open) const;
  /// Works out these grains by themselves (mend.hpp), unless there are too many.
  bool mend_few(State& state, std::vector<Index>& grains, double time) const;
  /// Makes the network of all contacts as they may be.
  void press(State& state, const PressOptions& options);
  /// Looks at all contacts: whether all S_i are below the bound as these may be; if so, the bound goes by that from now
  /// on.
  bool fits(State& state, double time, double slack);
  /// The same by other weights, once a look has found grains that do not fit.
  bool fits_by_sweeps(State& state, double time, double slack);
  /// Grains that are not proved below the bound.
  std::vector<Index> beyond(const StandingBound& bound, const ScalarWeights& found,
                            const std::vector<GrainPlay>& plays) const;
  void keep(StandingBound& bound, const ScalarWeights& weights, const std::vector<GrainPlay>& plays) const;
  bool has_lists_of(const State& state) const;
  /// The contacts of these grains as they are, springs of the damped network without couples.
  Network around(const State& state, const std::vector<Index>& grains) const;

  const Scene& scene_;
  std::vector<Index> i_, j_, id_;
  std::vector<std::uint8_t> image_;
  std::vector<std::array<Index, 2>> walls_;  ///< wall and grain
  std::vector<double> turn_;                 ///< leave of each grain in the check under way
  StandingBound next_;                       ///< room for follow()
  std::vector<std::size_t> fresh_;           ///< pairs that follow() met for the first time
  Look look_;                                ///< of the present lists once scheduled
  Pressed pressed_;                          ///< of the present lists once sides_ is set
  std::optional<Sides> sides_;
  std::optional<ScalarWeights> weights_;  ///< of a check that failed …
  bool outrun_ = false;                   ///< … because contacts had gone beyond what they were allowed before it
};

}  // namespace eg
