#include "timestep/allowance.hpp"

#include <algorithm>
#include <cmath>

#include "base/batch.hpp"
#include "timestep/outgrown.hpp"

namespace eg {
namespace {

constexpr double most_slack = 2;  // by which an overlap may grow, at most [-]

}  // namespace

OverlapForecast with_slack(OverlapForecast f, const ContactPoint& p, double slack) {
  const double more = slack * std::max(0.0, p.geometry.overlap);
  f.growth += more, f.driven += more;
  return f;
}

OverlapGrowth foreseen(const State& state, double time, double slack) {
  return [&state, time, slack](const ContactPoint& p) {
    return with_slack(forecast(state, p.i, p.j, p.geometry, time), p, slack);
  };
}

OverlapForecast with_room(const StandingBound& bound, const OverlapForecast& f, const ContactPoint& p, double slack,
                          double usual, double up_to) {
  const double most = std::max(bound.grain[p.i], p.j == no_index ? 0.0 : bound.grain[p.j]);
  const double stiffer = up_to * bound.value / most;
  if (p.geometry.overlap + f.growth <= 0) return f;
  const double roomy = std::clamp(stiffer * stiffer - 1, slack, most_slack);
  const double more = std::max(roomy * std::max(0.0, p.geometry.overlap),
                               std::clamp(2 * (stiffer - 1), 0.0, 1.0) * usual - p.geometry.overlap);
  return f.growth <= more ? OverlapForecast{more} : with_slack(f, p, slack);
}

double usual_overlap(const StandingBound& bound) {
  Batch total(0.0), count(0.0);
  const Batch zero(0.0), one(1.0);
  for (std::size_t c = 0; c < bound.overlap.size(); c += Contacts::lanes) {
    const Batch x = load_lanes(bound.overlap.data() + c);
    const Mask counts = (x > zero) & (x < Batch(INFINITY));
    total = total + select(counts, x, zero), count = count + select(counts, one, zero);
  }
  return sum(count) > 0 ? 0.5 * sum(total) / sum(count) : 0.0;
}

}  // namespace eg
