#pragma once
// The listed contacts as they may be until the next check: what each is allowed, and the spring that it then counts as.
// What is allowed is a choice, of which any is sound (certificates.md): what is foreseen, and as much more as leaves
// room for the rest, so that the bound survives what was not foreseen.
#include "assembly/damping.hpp"
#include "state/gather.hpp"
#include "timestep/play.hpp"

namespace eg {

struct PressOptions {
  double time = 0;   ///< until the next check [s]
  double slack = 0;  ///< by which every overlap may grow at least [-]
};

/// All listed contacts. Springs stand as in the lists, those that are not counted with no stiffness: pairs (padding
/// too), then walls, then, for laws with couples, those of all these against grain i and those of pairs against grain
/// j.
struct Pressed {
  Network network;
  std::size_t couples = 0;           ///< number of contacts, so where couples begin; 0: there are none
  std::vector<SpringMotion> motion;  ///< of every spring
};
/// Takes all contacts for what they may be where there is no bound yet, which begins one: sets overlap of
/// state.policy.bound.
Pressed press_contacts(const Scene& scene, State& state, const PressOptions& options);

/// What a contact counts as; stiffnesses of the damped network.
struct Counted {
  double normal = 0, tangential = 0;  ///< [N/m]
  double twisting = 0, rolling = 0;   ///< of twice the stiffness, against the ground [N m]
  double reach = 0;                   ///< the overlap that they belong to [m]; 0: touches nothing
};
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
/// Allows contacts what they need that no look has seen: sets overlap of state.policy.bound.
void allow(const Scene& scene, State& state, const ContactSelection& selection, const PressOptions& options);

/// The weight that leaves both grains of a pair the most room: minimises −ln(σ − S_i) − ln(σ − S_j) in the share of the
/// pair. `a`: what the pair adds to each S at weight 1; `room`: σ − S of each.
double centred_weight(double a_i, double room_i, double a_j, double room_j);
/// σ − S of a grain as weights see it.
double room_below(double sigma, double bound);

}  // namespace eg
