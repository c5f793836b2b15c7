#include "timestep/play.hpp"

namespace eg {

std::vector<double> plays_of(const Sides& sides, const std::vector<double>& t, std::span<const SpringMotion> met) {
  const Network& net = sides.network();
  std::vector<double> grains(sides.size());
  const auto add = [&](Index g, double weight, const Spring& s, const SpringMotion& m) {
    const Inertia inertia = inertia_of(net, g);
    grains[g] += weight * (s.couple ? play_of_couple(s.normal, s.tangential, m, inertia)
                                    : play(s.normal, s.tangential, m, inertia));
  };
  for (std::size_t c = 0; c < t.size(); ++c) {
    const Spring& s = net.springs[c];
    if (!acts(s)) continue;
    const bool split = sides.is_split(c);
    add(s.i, s.i == s.j ? 4 : split ? 1 + t[c] : 1, s, met[c]);
    if (s.j != no_index && s.j != s.i) add(s.j, split ? 1 + 1 / t[c] : 1, s, met[c]);
  }
  return grains;
}

}  // namespace eg
