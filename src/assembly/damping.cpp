#include "assembly/damping.hpp"

#include <cmath>

#include "assembly/damped_stiffness.hpp"

namespace eg {

namespace {

/// The spring as a dashpot; none resists rolling.
Spring dashpot(Spring s, double inverse_mass, const DampingSpec& damping) {
  const double mass = inverse_mass > 0 && !s.couple ? 1 / inverse_mass : 0.0;
  s.normal = 2 * damping.normal_ratio * std::sqrt(mass * s.normal);
  s.tangential = 2 * damping.shear_ratio * std::sqrt(mass * s.tangential);
  return s;
}

double inverse_mass(const Network& network, const Spring& s) {
  return network.inverse_mass[s.i] + (s.j == no_index ? 0.0 : network.inverse_mass[s.j]);
}

}  // namespace

Network dashpots(const Network& network, const DampingSpec& damping) {
  Network c = network;
  for (Spring& s : c.springs) s = dashpot(s, inverse_mass(network, s), damping);
  return c;
}

Spring damped_spring(Spring spring, double inverse_mass, const DampingSpec& damping, double step) {
  const auto damped = [&](double k, double ratio) {
    return damped_stiffness(k, inverse_mass, spring.couple ? 0.0 : ratio, damping.local, step);
  };
  spring.normal = damped(spring.normal, damping.normal_ratio);
  spring.tangential = damped(spring.tangential, damping.shear_ratio);
  return spring;
}

Network damped_network(const Network& network, const DampingSpec& damping, double step) {
  Network k = network;
  for (Spring& s : k.springs) s = damped_spring(s, inverse_mass(network, s), damping, step);
  return k;
}

}  // namespace eg
