#include "timestep/some_grains.hpp"

#include "timestep/play.hpp"

namespace eg {

SomeGrains::SomeGrains(const State& state) : state_(state), local_(state.grains.size(), no_index) {}

Index SomeGrains::take_in(Index grain) {
  if (!has(grain)) {
    local_[grain] = static_cast<Index>(grains_.size());
    grains_.push_back(grain);
  }
  return local_[grain];
}

std::vector<std::size_t> SomeGrains::pairs() const {
  const auto& list = state_.contacts;
  std::vector<std::size_t> found;
  for (std::size_t c = 0; c < list.size(); ++c)
    if ((has(list.i[c]) || has(list.j[c])) && !list.is_padding(c)) found.push_back(c);
  return found;
}

std::vector<std::size_t> SomeGrains::walls() const {
  std::vector<std::size_t> found;
  for (std::size_t w = 0; w < state_.wall_contacts.size(); ++w)
    if (has(state_.wall_contacts[w].grain)) found.push_back(w);
  return found;
}

Network SomeGrains::network() const {
  Network net;
  net.dimension = state_.dimension, net.rotation = state_.grains.rotates();
  for (const Index g : grains_) {
    const Inertia inertia = inertia_of(state_.grains, g);
    net.inverse_mass.push_back(inertia.inverse_mass), net.radius.push_back(inertia.radius);
    if (net.rotation) net.inverse_inertia.push_back(inertia.inverse_inertia);
  }
  return net;
}

}  // namespace eg
