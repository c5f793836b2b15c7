#include "assembly/damping.hpp"

#include <cmath>

namespace eg {

Network dashpots(const Network& network, const DampingSpec& damping) {
  Network c = network;
  for (Spring& s : c.springs) {
    const double inverse = network.inverse_mass[s.i] + (s.j == no_index ? 0.0 : network.inverse_mass[s.j]);
    const double mass = inverse > 0 ? 1 / inverse : 0.0;
    s.normal = 2 * damping.normal_ratio * std::sqrt(mass * s.normal);
    s.tangential = 2 * damping.shear_ratio * std::sqrt(mass * s.tangential);
  }
  return c;
}

Network damped_network(const Network& network, const DampingSpec& damping, double step) {
  Network k = dashpots(network, damping);
  for (std::size_t n = 0; n < k.springs.size(); ++n) {
    const Spring& s = network.springs[n];
    Spring& sum = k.springs[n];
    sum.normal = (1 + damping.local) * (s.normal + 2 * sum.normal / step);
    sum.tangential = (1 + damping.local) * (s.tangential + 2 * sum.tangential / step);
  }
  return k;
}

}  // namespace eg
