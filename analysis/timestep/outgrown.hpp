#pragma once
// Which contacts may come to overlap more than they are allowed: one look at every listed pair, eight at a time.
#include <span>
#include <vector>

#include "state/gather.hpp"

namespace eg {

/// How fast contacts are taken to close, over how fast they do.
inline constexpr double closing_margin = 1.5;

/// How far a pair may be pressed in that time [s]: straight on with closing_margin times its closing speed, and at most
/// until that motion is used up twice. j == no_index: a wall, the fastest there is.
OverlapForecast forecast(const State& state, Index i, Index j, const Geometry<double>& g, double time);

/// Pairs of State::contacts whose overlap, going straight on, passes what is allowed (a value an entry [m], infinite
/// for padding). Ascending.
std::vector<std::size_t> outgrown_pairs(const State& state, std::span<const double> allowed, double time);
/// The same of State::wall_contacts.
std::vector<std::size_t> outgrown_walls(const State& state, std::span<const double> allowed, double time);

}  // namespace eg
