#include "timestep/approach.hpp"

#include <algorithm>

namespace eg {
namespace {

double fastest(const State& state) {
  double speed = 0;
  for (const auto& b : state.bodies) speed = std::max(speed, norm(b.velocity) + std::abs(b.opening));
  return speed;
}

}  // namespace

CommonMotion::CommonMotion(const State& state) : closing(state.cell.rate), fastest_wall(fastest(state)) {
  for (std::size_t c = 0; c < Cell::images; ++c) shift[c].set(state.cell.shift(static_cast<std::uint8_t>(c)));
  for (int k = 0; k < 3; ++k) closing(k, k) -= state.preparation.growth;  // radii grow as if space shrank
}

Approach<double> CommonMotion::at_wall(const State& state, const WallContact& contact, const Vec3& n) const {
  const Vec3 v = state.grains.velocity[contact.grain].vec();
  const double radius = state.grains.radius(contact.grain);
  const double driven = closing_margin * std::max(0.0, fastest_wall + state.preparation.growth * radius);
  const Wall& wall = state.walls[contact.wall];
  const bool flat = wall.shape == Wall::plane && !wall.windowed();
  return {driven + closing_margin * std::max(0.0, dot(v, n)), driven,
          flat ? 0.0 : closing_margin * (norm(v) + fastest_wall) / radius};
}

}  // namespace eg
