#pragma once
// A bound of λmax that stands while the packing moves on, and the check that it still does.
//
// A renewal bounds the S_i of contact splitting with every pair at the overlap that it is allowed, somewhat more than
// it has. A check looks at all listed pairs at the overlap and the direction that they can reach until the next one.
// Pairs within what they are allowed change nothing. Each of the others adds at most
// (1 + t^±1) max(Δkn/m, Δkt (1/m + R²/I)) to λmax(S_i) of its grains (Weyl 1912), and something for its turn; a grain
// whose sum does not fit below the bound is worked out afresh. A spring of couples is counted as one of twice its
// stiffness against the ground on each of its grains, which is not less. Proof: certificates.md.
#include "assembly/damping.hpp"
#include "state/gather.hpp"
#include "timestep/play.hpp"

namespace eg {

struct RenewOptions {
  double time = 0;   ///< until the next check [s]
  double slack = 0;  ///< by which every overlap may grow before it counts as outgrown [-]
  double room = 0;   ///< by which the bound is to exceed what the packing needs now [-]
  double floor = 0;  ///< least value of the bound [1/s²]
  double step = 0;   ///< at which dashpots are counted [s] (damped_network)
};

struct StandingCheck {
  bool stands = true;
  std::size_t outgrown = 0;  ///< contacts beyond what they are allowed, in overlap or direction
  std::size_t examined = 0;  ///< grains worked out afresh
  bool outrun = false;  ///< a contact had gone beyond what it was allowed already, and its grain may have had no room
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
  /// The same after follow(), for what is left of the time that the last check was for: looks at new pairs only.
  StandingCheck check_fresh(State& state, double time, double slack);

 private:
  /// The springs of a contact as the damped network has them.
  struct Springs {
    Spring contact;
    Spring couple;  ///< of twice the stiffness; nothing where the contact has none
  };
  struct Counted {
    double normal = 0, tangential = 0, twisting = 0, rolling = 0;  ///< their stiffnesses
    double reach = 0;                                              ///< the overlap that they belong to [m]
  };
  /// A contact that may be beyond what it is allowed.
  struct Beyond {
    Index i, j;
    std::size_t entry;
    Vec3 n;
    double turned, turning;  ///< |n − n₀| now, and how much may come to it until the next check
    bool outran;             ///< its overlap is beyond it already
    Counted now, before;     ///< at what it is to be allowed, at what it was
  };
  struct Part {
    Network network;                 ///< some grains, numbered afresh, first those asked for; then their neighbours
    std::vector<std::size_t> entry;  ///< of each spring in State::contacts; no_entry for a wall
    std::vector<std::size_t> pairs, walls;       ///< all listed contacts of the grains asked for …
    std::vector<double> pair_reach, wall_reach;  ///< … and the overlap they were counted at [m], 0 when not at all
    std::vector<SpringMotion> met;               ///< of each spring
  };
  static constexpr std::size_t no_entry = ~std::size_t{0};

  Springs springs_of(const State& state, const ContactPoint& contact) const;
  Counted counted(const State& state, const ContactPoint& contact) const;
  static double turned(const State& state, const ContactPoint& contact);
  /// `time`: until the next check [s]; `couples`: whether to count them: without, λmax of the part is no upper bound.
  Part part(const State& state, const std::vector<Index>& grains, const OverlapGrowth& growth, double time,
            bool couples);
  StandingCheck check(State& state, const ContactSelection& selection, double time, double slack);
  /// Fills beyond_ with those of the contacts that may pass what they are allowed within that time.
  void find_beyond(const State& state, const ContactSelection& selection, double time, double slack);
  /// Allows such a contact more, and adds what that may add to λmax(S_i) of its grains.
  void add_excess(State& state, const Beyond& contact);
  /// Places in State::contacts of all pairs of these grains, ascending.
  std::vector<std::size_t> pairs_of(const State& state, const std::vector<Index>& grains);
  /// Works out S_i of these grains with their pairs grown so; if all stay below the bound for that time, allows the
  /// pairs no more.
  bool examine(State& state, const std::vector<Index>& grains, const OverlapGrowth& growth, double time);

  const Scene& scene_;
  DampingSpec damping_;
  std::vector<Index> i_, j_, id_;
  std::vector<std::uint8_t> image_;
  std::vector<std::array<Index, 2>> walls_;  ///< wall and grain
  std::vector<double> turn_;                 ///< leave of each grain in the check under way
  std::vector<Index> doubtful_;              ///< grains that may have passed the bound
  bool outrun_ = false;                      ///< some of them before the check
  std::vector<std::size_t> fresh_;           ///< pairs that follow() met for the first time
  std::vector<Beyond> beyond_;
  std::vector<std::uint8_t> asked_;  ///< grains whose pairs are wanted
  std::vector<Index> place_;         ///< of a grain in a part; no_index between calls
};

}  // namespace eg
