#include "timestep/play.hpp"

#include <algorithm>
#include <cmath>

namespace eg {
Inertia inertia_of(const Network& net, Index g) {
  return {net.inverse_mass[g], net.rotation ? net.inverse_inertia[g] : 0.0, net.radius[g]};
}
Inertia inertia_of(const Grains& g, Index i) { return {g.velocity[i].w, g.rotates() ? g.spin[i].w : 0.0, g.radius(i)}; }

double most_added(double kn, double kt, const Inertia& g) {
  return std::max(kn * g.inverse_mass, kt * (g.inverse_mass + g.inverse_inertia * g.radius * g.radius));
}

// Of S_i, the block of translations changes by at most |kn − kt| |n − n₀|, that of rotations by kt a² as much, those
// beside by kt a as much. An arm changes by no more than half of the overlap.
Play play(double kn, double kt, double reach, const Inertia& g) {
  const double shift = std::abs(kn - kt) * g.inverse_mass, turn = kt * g.radius * g.radius * g.inverse_inertia,
               mixed = kt * g.radius * std::sqrt(g.inverse_mass * g.inverse_inertia);
  const double norm = 0.5 * (shift + turn) + std::sqrt(0.25 * (shift - turn) * (shift - turn) + mixed * mixed);
  return {norm * sum_rounding, (0.5 * mixed + turn) * std::max(0.0, reach) / g.radius * sum_rounding};
}
Play play_of_couple(double twisting, double rolling, const Inertia& g) {
  return {std::abs(twisting - rolling) * g.inverse_inertia * sum_rounding, 0};
}

std::vector<GrainPlay> plays_of(const Sides& sides, const std::vector<double>& t, std::span<const SpringMotion> met) {
  const Network& net = sides.network();
  std::vector<GrainPlay> grains(sides.size());
  const auto add = [&](Index g, double weight, const Spring& s, const SpringMotion& m) {
    const Inertia inertia = inertia_of(net, g);
    const Play p =
        s.couple ? play_of_couple(s.normal, s.tangential, inertia) : play(s.normal, s.tangential, m.reach, inertia);
    grains[g].turn += weight * p.turn;
    grains[g].counted += weight * (p.arm + p.turn * m.turned);
    grains[g].ahead += weight * (p.arm + p.turn * m.turning);
  };
  for (std::size_t c = 0; c < t.size(); ++c) {
    const Spring& s = net.springs[c];
    const bool split = sides.is_split(c);
    add(s.i, s.i == s.j ? 4 : split ? 1 + t[c] : 1, s, met[c]);
    if (s.j != no_index && s.j != s.i) add(s.j, split ? 1 + 1 / t[c] : 1, s, met[c]);
  }
  return grains;
}

}  // namespace eg
