#pragma once
// A bound of λmax that stands while the packing moves on, and the check that it still does.
//
// A renewal bounds the S_i of contact splitting with every pair at the overlap that it is allowed, somewhat more than
// it has and may reach until the next check, and with what its turning until then may add. A check does the same for
// the bound in force: it stands when all S_i stay below. The few grains that do not are mended by weights of their own
// (mend.hpp). A pair that a list brings in between checks adds at most (1 + t^±1) max(kn/m, kt (1/m + R²/I)) to
// λmax(S_i) of its grains (Weyl 1912), and something for its turning. A spring of couples is counted as one of twice
// its stiffness against the ground on each of its grains, which is not less. Proof: certificates.md.
#include "timestep/look.hpp"
#include "timestep/scalar_weights.hpp"

namespace eg {

struct RenewOptions {
  double time = 0;     ///< until the next check [s]
  double slack = 0;    ///< by which every overlap may grow at least [-]
  double room = 0;     ///< by which the bound is to exceed what the packing needs now [-]
  double floor = 0;    ///< least value of the bound [1/s²]
  double step = 0;     ///< at which dashpots are counted [s] (damped_network)
  bool afresh = true;  ///< false: a check that failed just now has looked at all contacts, for the same time and step
};

struct StandingCheck {
  bool stands = true;
  std::size_t mended = 0;  ///< grains that needed weights of their own
  bool outrun = false;     ///< it fails by a grain with a contact that had gone beyond what it was allowed before
};

/// Keeps state.policy.bound, which is all that it remembers but for scratch and the keys of the lists. `schedule` below
/// is that of the present lists.
class StandingBounds {
 public:
  explicit StandingBounds(const Scene& scene) : scene_(scene) {}

  /// Takes note of the lists that the bound is for.
  void remember(const State& state);
  /// A new bound, warm-started from the old one if that has a meaning yet; returns a lower bound of λmax of the packing
  /// as it is [1/s²].
  double renew(State& state, const Schedule& schedule, const RenewOptions& options);
  /// Carries the bound over to the present lists. False when the grains have been sorted anew: it has no meaning then.
  bool follow(State& state);
  /// Whether λmax ≤ bound.value for the `time` to come [s], with overlaps free to grow by the slack [-] at least.
  StandingCheck check(State& state, const Schedule& schedule, double time, double slack);
  /// After follow(), for what is left of the time that the last check was for: whether the new pairs leave the bound as
  /// it is. If not, all are to be checked.
  bool check_fresh(State& state, double time, double slack);

 private:
  /// A bound where there is none to begin with.
  void begin(State& state, const RenewOptions& options);
  /// Adds what a contact may add to λmax(S_i) of its grains; those that do not stay below the bound go to `open`.
  void add_fresh(State& state, const CountedContact& contact, std::vector<Index>& open) const;
  /// Works out these grains by themselves (mend.hpp), unless there are too many.
  bool mend_few(State& state, std::vector<Index>& grains, double time) const;
  bool has_lists_of(const State& state) const;
  /// Whether the last look found a contact of these grains beyond what it had been allowed.
  bool has_outrun(const State& state, const std::vector<Index>& grains) const;
  /// λmax of a self block of the stiffest grains as they are, a lower bound of λmax.
  double known_stiffness(const State& state) const;

  const Scene& scene_;
  std::vector<Index> i_, j_, id_;
  std::vector<std::uint8_t> image_;
  std::vector<std::uint64_t> chunk_begin_;
  std::vector<std::array<Index, 2>> walls_;             ///< wall and grain
  StandingBound next_;                                  ///< room for follow()
  std::vector<std::size_t> fresh_pairs_, fresh_walls_;  ///< that follow() met for the first time
  Look look_;
};

}  // namespace eg
