#include "boundary/membrane.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"
#include "boundary/outer_surface.hpp"

namespace eg {
namespace {

/// What each corner of a triangle gets of its area: the part nearest to it, so that shares change steadily when the
/// triangulation turns over a diagonal. An obtuse corner gets half, the others a quarter (Meyer et al. 2003).
std::array<double, 3> shares_of(const std::array<Vec3, 3>& x) {
  std::array<double, 3> cosine{}, cotangent{}, square{};
  const double twice = norm(cross(x[1] - x[0], x[2] - x[0]));
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 a = x[(k + 1) % 3] - x[k], b = x[(k + 2) % 3] - x[k];
    cosine[k] = dot(a, b), cotangent[k] = cosine[k] / twice;
    square[k] = dot(b - a, b - a);  // of the side across
  }
  std::array<double, 3> share{};
  for (std::size_t k = 0; k < 3; ++k) {
    if (cosine[k] <= 0) {
      share = {0.25, 0.25, 0.25};
      share[k] = 0.5;
      return share;
    }
    const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
    share[k] = (square[l] * cotangent[l] + square[m] * cotangent[m]) / (4 * twice);
  }
  return share;
}

[[noreturn]] void report_lost(const State& state, const std::vector<Index>& lost) {
  const Vec3 x = state.grains.position[lost[0]].vec();
  throw RunError(fmt::format(
      "step {}: the membrane lets {} grain{} through, grain {} at ({:.6g}, {:.6g}, {:.6g}) m; the specimen has come "
      "apart there, or boundary.membrane.probe is too small: raise it, or end the stage earlier",
      state.step, lost.size(), lost.size() == 1 ? "" : "s", state.grains.id[lost[0]], x.x, x.y, x.z));
}

double probe_of(const Scene& scene, const State& state) {
  if (!std::isnan(scene.boundary.membrane->probe)) return scene.boundary.membrane->probe;
  double mean = 0;
  for (const auto& p : state.grains.position) mean += p.w / static_cast<double>(state.grains.size());
  return state.dimension == 3 ? mean : mean / 2;
}

}  // namespace

double membrane_stress(const Scene& scene, const State& state) {
  return state.stage < scene.stages.size() ? scene.stages[state.stage].membrane_stress : state.membrane.stress;
}

void lay_membrane(const Scene& scene, State& state) {
  state.applied.clear();
  state.membrane = {};
  const double stress = membrane_stress(scene, state);
  if (!scene.boundary.membrane || stress == 0) return;
  const OuterSurface surface = outer_surface(state, probe_of(scene, state));
  if (!surface.lost.empty()) report_lost(state, surface.lost);
  state.membrane.stress = stress, state.membrane.volume = surface.volume, state.membrane.solid = surface.solid;
  std::vector<Vec3> force(state.grains.size());
  const auto corners = static_cast<std::size_t>(state.dimension);
  for (const auto& facet : surface.facets) {
    if (facet.planes != 0) continue;
    const Vec3 outward = facet.outward(state.dimension);
    state.membrane.area += norm(outward);
    const auto share = corners == 3 ? shares_of(facet.corner) : std::array<double, 3>{0.5, 0.5, 0};
    for (std::size_t k = 0; k < corners; ++k) force[facet.grain[k]] -= outward * (stress * share[k]);
  }
  for (Index g = 0; g < force.size(); ++g) {
    if (!(dot(force[g], force[g]) > 0)) continue;
    state.applied.push_back({g, force[g]});
    state.membrane.net += force[g];
    for (int k = 0; k < 3; ++k) state.membrane.moment[k] += force[g][k] * state.grains.position[g].vec()[k];
  }
}

double applied_work(const State& state, double dt) {
  double power = 0;
  for (const auto& f : state.applied) power += dot(f.force, state.grains.velocity[f.grain].vec());
  return power * dt;
}

}  // namespace eg
