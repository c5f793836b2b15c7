#pragma once
// The listed contacts as they may be until the next check: what each is allowed, and the spring that it then counts as.
// What is allowed is a choice, of which any is sound (certificates.md): what is foreseen, and as much more as leaves
// room for the rest, so that a contact need not be looked at again for long.
#include "assembly/damping.hpp"
#include "state/gather.hpp"
#include "state/schedule.hpp"
#include "timestep/grain_sums.hpp"

namespace eg {

struct PressOptions {
  double time = 0;   ///< until the next check [s]
  double slack = 0;  ///< by which every overlap may grow at least before it counts as outgrown [-]
  /// Weights of pairs as a look at all contacts left them; what they are allowed then is as it left it, too.
  std::span<const double> looked = {};
};

/// All listed contacts. Springs stand as in the lists, those that are not counted with no stiffness: pairs (padding
/// too), then walls, then, for laws with couples, those of all these against grain i and those of pairs against grain
/// j.
struct Pressed {
  Network network;
  std::size_t couples = 0;           ///< number of contacts, so where couples begin; 0: there are none
  std::vector<double> weight;        ///< t of every spring, > 0
  std::vector<SpringMotion> motion;  ///< of every spring
};

/// What a look at all contacts finds.
struct Look {
  std::vector<double> weight;        ///< t of every pair, 0 where it is not counted
  std::vector<std::uint8_t> outran;  ///< pairs, then walls: whether one overlaps by more than it was allowed so far
  std::size_t terms = 0;             ///< more than any of the sums below is made of
  AlignedVector<GrainSums> rows;     ///< grain after grain, then what the schedule needs
  Schedule schedule;                 ///< of the lists …
  bool scheduled = false;            ///< … that are present
  BlockRanges ranges{0};             ///< of grains, by those sums
  std::vector<GrainPlay> plays;
};
/// For new lists.
void lay_out(const State& state, Look& out);
/// Takes all contacts for what they may be, which sets overlap and direction of state.policy.bound, and adds up what
/// that means for each grain. There is a bound already.
void look_at_all(const Scene& scene, State& state, const PressOptions& options, Look& out);

/// The springs of the present lists, all without stiffness.
void lay_out(const Scene& scene, const State& state, Pressed& out);
/// Takes all contacts for what they may be. Sets overlap and direction of state.policy.bound, reads the rest of it;
/// with bound.value == 0 all weights are 1.
void press_contacts(const Scene& scene, State& state, const PressOptions& options, Pressed& out);

/// What a contact counts as; stiffnesses of the damped network.
struct Counted {
  double normal = 0, tangential = 0;  ///< [N/m]
  double twisting = 0, rolling = 0;   ///< of twice the stiffness, against the ground [N m]
  double reach = 0;                   ///< the overlap that they belong to [m]; 0: touches nothing
};
/// A contact that may be beyond what it is allowed.
struct Beyond {
  Index i, j;  ///< j == no_index: a wall
  std::size_t entry;
  Vec3 n;
  double turned, turning;  ///< |n − n₀| now, and how much may come to it until the next check
  bool outran;             ///< its overlap is beyond it already
  Counted now, before;     ///< at what it is to be allowed, at what it is
};
/// Those of the contacts that really are. `turn`: of every grain, by how much its contacts may be off.
std::vector<Beyond> look_beyond(const Scene& scene, const State& state, const ContactSelection& selection,
                                std::span<const double> turn, const PressOptions& options);

/// A contact as it is counted.
struct CountedContact {
  Index i, j;         ///< j == no_index: a wall
  std::size_t entry;  ///< of its list
  Spring spring;      ///< of the same grains, with its present direction and arms
  SpringMotion motion;
  Counted counted;
};
/// Those of the contacts that count for anything, at what they are allowed.
std::vector<CountedContact> counted_contacts(const Scene& scene, const State& state, const ContactSelection& selection,
                                             double time);

/// The weight that leaves both grains of a pair the most room: minimises −ln(σ − S_i) − ln(σ − S_j) in the share of the
/// pair. `a`: what the pair adds to each S at weight 1; `room`: σ − S of each.
double centred_weight(double a_i, double room_i, double a_j, double room_j);
/// σ − S of a grain as weights see it.
double room_below(double sigma, double bound);

}  // namespace eg
