#pragma once
// Which contacts may come to overlap more, or turn further, than they are allowed: one look at every listed pair, eight
// at a time.
#include <span>
#include <vector>

#include "state/gather.hpp"

namespace eg {

/// How fast contacts are taken to close, over how fast they do.
inline constexpr double closing_margin = 1.5;

/// What contacts may do unnoticed: overlaps and directions as in StandingBound, and a value a grain [-], how far off
/// the directions of its contacts may be, |n − n₀|.
struct Leave {
  const StandingBound& bound;
  std::span<const double> turn;
};

/// Where StandingBound::direction keeps a component.
inline std::size_t direction_place(std::size_t entry, std::size_t component) {
  constexpr std::size_t lanes = Contacts::lanes;
  return (entry / lanes * 3 + component) * lanes + entry % lanes;
}
/// n of a pair as it was counted; 0 when it was not.
inline Vec3 counted_direction(const StandingBound& bound, std::size_t entry) {
  const auto at = [&](std::size_t k) { return bound.direction[direction_place(entry, k)]; };
  return {at(0), at(1), at(2)};
}
inline void set_direction(StandingBound& bound, std::size_t entry, const Vec3& n) {
  const auto at = [&](std::size_t k) -> float& { return bound.direction[direction_place(entry, k)]; };
  at(0) = static_cast<float>(n.x), at(1) = static_cast<float>(n.y), at(2) = static_cast<float>(n.z);
}

/// How far a pair may be pressed in that time [s]: straight on with closing_margin times its closing speed, and at most
/// until that motion is used up twice. j == no_index: a wall, the fastest there is.
OverlapForecast forecast(const State& state, Index i, Index j, const Geometry<double>& g, double time);

/// By how much the direction of a contact may change in that time, |Δn|, going straight on with closing_margin times
/// its speed.
double turn_forecast(const State& state, const ContactPoint& p, double time);

/// Pairs of State::contacts whose overlap or direction, going straight on, passes what is allowed, some whose direction
/// only comes near it; ascending.
std::vector<std::size_t> outgrown_pairs(const State& state, const Leave& leave, double time);
/// The same of State::wall_contacts.
std::vector<std::size_t> outgrown_walls(const State& state, const Leave& leave, double time);

}  // namespace eg
