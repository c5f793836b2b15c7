#include "measure/measure_sphere.hpp"

#include <algorithm>
#include <cmath>

#include "measure/contact_network.hpp"
#include "measure/gradient_fit.hpp"
#include "measure/images.hpp"
#include "measure/volume.hpp"

namespace eg {

double share_inside(const Vec3& a, const Vec3& b, const MeasureSphere& sphere) {
  const Vec3 along = b - a, from = a - sphere.centre;
  const double length2 = dot(along, along), half = -dot(along, from);
  const double root2 = half * half - length2 * (dot(from, from) - sphere.radius * sphere.radius);
  if (!(root2 > 0) || !(length2 > 0)) return 0;
  const double root = std::sqrt(root2);
  return std::max(0.0, std::min(1.0, (half + root) / length2) - std::max(0.0, (half - root) / length2));
}

SphereMeasures measure_sphere(const State& state, std::span<const ContactPoint> contacts, const MeasureSphere& sphere) {
  const int dimension = state.dimension;
  const auto& grains = state.grains;
  const auto ends = contacts_per_grain(grains.size(), contacts);
  SphereMeasures result;
  result.volume = grain_volume(dimension, sphere.radius);
  std::vector<Sample> inside;  // velocities of grains, or images of them, with their centre inside
  double solid = 0, touching = 0;
  for (std::size_t i = 0; i < grains.size(); ++i) {
    const Vec3 x = grains.position[i].vec();
    visit_images(state.cell, x, sphere.centre, sphere.radius + grains.radius(i), [&](const Vec3& shift) {
      const Vec3 image = x + shift;
      const double distance = norm(image - sphere.centre);
      solid += lens_volume(dimension, sphere.radius, grains.radius(i), distance);
      if (distance > sphere.radius) return;
      inside.push_back({image, grains.velocity[i].vec() + state.cell.rate * image});
      touching += ends[i];
    });
  }
  result.solid_fraction = solid / result.volume;
  result.void_ratio = void_ratio(result.volume, solid);
  result.grains = inside.size();
  if (!inside.empty()) result.coordination = touching / static_cast<double>(inside.size());
  result.velocity_gradient = fit_gradient(inside, dimension);
  for (const auto& c : contacts) {
    const Vec3 from = grains.position[c.i].vec();
    double share = 0;
    visit_images(state.cell, from, sphere.centre, sphere.radius + norm(c.branch),
                 [&](const Vec3& shift) { share += share_inside(from + shift, from + shift + c.branch, sphere); });
    if (share > 0) result.stress += (share / result.volume) * outer(c.force(), c.branch);
  }
  return result;
}

}  // namespace eg
