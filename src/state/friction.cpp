#include "state/friction.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/random.hpp"

namespace eg {
namespace {

/// Factor that belongs to two numbers: normal by Box and Muller (1958) from a stream that they seed.
double factor_of(const FrictionScatter& s, std::uint64_t a, std::uint64_t b) {
  std::uint64_t state = s.seed ^ (a << 32 | b);
  const double radius = std::sqrt(-2 * std::log1p(-next_uniform(state)));
  return std::max(0.0, 1 + s.deviation * radius * std::cos(2 * std::numbers::pi * next_uniform(state)));
}

}  // namespace

std::vector<double> pair_friction(const Scene& scene, const StageSpec& stage) {
  const auto& materials = scene.materials;
  auto given = stage.material_friction;
  given.resize(materials.size());
  std::vector<double> table;
  for (std::size_t k = 0; k < materials.size(); ++k)
    for (std::size_t l = 0; l < materials.size(); ++l) {
      const Material &a = materials[k], &b = materials[l];
      double friction = std::min(given[k].value_or(a.friction), given[l].value_or(b.friction));
      if (!given[k] && !given[l])
        for (const PairSpec& p : scene.contact.pairs)
          if ((p.first == a.name && p.second == b.name) || (p.first == b.name && p.second == a.name))
            friction = p.friction;
      table.push_back(stage.friction.value_or(friction));
    }
  return table;
}

std::vector<double> friction_in_force(const Scene& scene, const State& state) {
  return state.friction.empty() ? pair_friction(scene) : state.friction;
}

bool has_friction(const Scene& scene) {
  const auto positive = [](double mu) { return mu > 0; };
  return std::ranges::any_of(pair_friction(scene), positive) ||
         std::ranges::any_of(
             scene.stages, [&](const StageSpec& s) { return std::ranges::any_of(pair_friction(scene, s), positive); });
}

FrictionScatter friction_scatter(const Scene& scene) {
  return {scene.contact.friction_deviation, scene.contact.friction_by_grain, scene.seed};
}

void scatter_friction(State& state, const FrictionScatter& scatter) {
  state.friction_scatter = scatter;
  const auto& id = state.grains.id;
  auto& list = state.contacts;
  list.friction.assign(scatter.deviation > 0 ? list.size() : 0, 1.0);
  for (std::size_t c = 0; c < list.friction.size(); ++c)
    list.friction[c] = friction_factor(scatter, id[list.i[c]], id[list.j[c]]);
  for (auto& c : state.wall_contacts) c.friction = wall_friction_factor(scatter, id[c.grain], c.wall);
}

double friction_factor(const FrictionScatter& s, Index id_i, Index id_j) {
  if (!(s.deviation > 0)) return 1;
  if (s.by_grain) return std::min(factor_of(s, id_i, 0), factor_of(s, id_j, 0));
  return factor_of(s, std::min(id_i, id_j), std::max(id_i, id_j));
}

double wall_friction_factor(const FrictionScatter& s, Index id, Index wall) {
  if (!(s.deviation > 0)) return 1;
  return s.by_grain ? factor_of(s, id, 0) : factor_of(s, id, no_index - wall);
}

}  // namespace eg
