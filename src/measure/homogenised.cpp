#include "measure/homogenised.hpp"

#include <algorithm>

#include "measure/fabric.hpp"
#include "measure/stress.hpp"

namespace eg {

double anisotropy(const Principal& p, int dimension) {
  return p.values[0] - p.values[static_cast<std::size_t>(dimension - 1)];
}

Homogenised homogenise(const Scene& scene, const State& state) {
  const auto contacts = touching_contacts(scene, state);
  const std::size_t grains = state.grains.size();
  const int dimension = state.dimension;
  Homogenised result;
  result.sizes = size_statistics(state);
  result.volume = specimen_volume(state);
  const double solid = solid_volume(state);
  result.solid_fraction = solid / result.volume;
  result.void_ratio = void_ratio(result.volume, solid);
  result.void_ratio_corrected = void_ratio(result.volume, solid - overlap_volume(state, contacts));

  const bool friction = std::any_of(state.friction.begin(), state.friction.end(), [](double mu) { return mu > 0; });
  result.rattler_minimum = friction ? 2 : dimension + 1;
  result.coordination = coordination(grains, contacts);
  result.backbone = backbone(grains, contacts, result.rattler_minimum);
  result.fabric = fabric_tensor(contacts);
  result.fabric_axes = principal(result.fabric, dimension);
  result.force_fabric = force_fabric_tensor(contacts);
  result.force_fabric_axes = principal(result.force_fabric, dimension);
  result.forces = force_network(contacts, dimension);
  result.largest_overlap = largest_overlap(state, contacts);
  result.sliding_fraction = sliding_fraction(contacts);

  result.stress = stress(contacts, result.volume);
  result.normal_share = deviator_share(stress_parts(contacts, result.volume).normal, result.stress, dimension);
  result.mean_stress = mean_value(result.stress, dimension);
  result.deviator = deviator(result.stress, dimension);
  result.unbalanced_force = unbalanced_force(state, contacts, scene.gravity);
  result.kinetic_energy = kinetic_energy(state);
  result.elastic_energy = elastic_energy(contacts);
  return result;
}

}  // namespace eg
