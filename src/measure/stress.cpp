#include "measure/stress.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace eg {

Mat3 stress(std::span<const ContactPoint> contacts, double volume) {
  Mat3 sum;
  for (const auto& c : contacts) sum += outer(c.force(), c.branch);
  sum *= 1 / volume;
  return sum;
}

std::vector<Vec3> net_forces(const State& state, std::span<const ContactPoint> contacts, const Vec3& gravity) {
  const auto& grains = state.grains;
  std::vector<Vec3> net(grains.size());
  for (std::size_t i = 0; i < net.size(); ++i)
    if (grains.velocity[i].w > 0) net[i] = (1 / grains.velocity[i].w) * gravity;
  for (const auto& f : state.applied) net[f.grain] += f.force;
  for (const auto& c : contacts) {
    const Vec3 force = c.force();
    net[c.i] -= force;
    if (c.j != no_index) net[c.j] += force;
  }
  for (std::size_t i = 0; i < net.size(); ++i)
    if (grains.velocity[i].w == 0) net[i] = {};
  return net;
}

double unbalanced_force(const State& state, std::span<const ContactPoint> contacts, const Vec3& gravity) {
  double contact_sum = 0, net_sum = 0, moving = 0;
  for (const auto& c : contacts) contact_sum += norm(c.force());
  if (contact_sum == 0) return 1;
  for (const Vec3& force : net_forces(state, contacts, gravity)) net_sum += norm(force);
  for (const Quad& velocity : state.grains.velocity) moving += velocity.w > 0;
  return moving > 0 ? net_sum / moving / (contact_sum / static_cast<double>(contacts.size())) : 0;
}

double kinetic_energy(const State& state) {
  double twice = 0;
  for (const Quad& v : state.grains.velocity)
    if (v.w > 0) twice += dot(v.vec(), v.vec()) / v.w;
  for (const Quad& spin : state.grains.spin)
    if (spin.w > 0) twice += dot(spin.vec(), spin.vec()) / spin.w;
  return twice / 2;
}

double elastic_energy(std::span<const ContactPoint> contacts) {
  double sum = 0;
  for (const auto& c : contacts) sum += c.normal_energy + c.shear_energy;
  return sum;
}

double driving_rate(const State& state, const StageSpec& stage) {
  constexpr std::array<std::array<int, 2>, 6> places{{{0, 0}, {1, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}}};
  double driven = 0, any = 0;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const double rate = std::abs(state.cell.rate(places[k][0], places[k][1]));
    any = std::max(any, rate);
    const auto kind = stage.control[k].kind;
    if (kind == ComponentControl::Kind::rate || kind == ComponentControl::Kind::inertial)
      driven = std::max(driven, rate);
  }
  return driven > 0 ? driven : any;
}

double inertial_number(double strain_rate, double diameter, double density, double mean_stress) {
  return std::abs(strain_rate) * diameter * std::sqrt(density / mean_stress);
}

}  // namespace eg
