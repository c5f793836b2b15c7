#include "timestep/outgrown.hpp"

#include <algorithm>

#include "contact/interaction.hpp"
#include "contact/lanes.hpp"
#include "state/wall_geometry.hpp"

namespace eg {
namespace {

double fastest_wall(const State& state) {
  double speed = 0;
  for (const auto& b : state.bodies) speed = std::max(speed, norm(b.velocity) + std::abs(b.opening));
  return speed;
}

/// Velocity gradient by which surfaces close in: that of the cell, and radii that grow as if space shrank.
Mat3 closing_gradient(const State& state) {
  Mat3 rate = state.cell.rate;
  for (int k = 0; k < 3; ++k) rate(k, k) -= state.preparation.growth;
  return rate;
}

using Shifts = std::array<Quad, Cell::images>;

constexpr std::size_t lanes = Contacts::lanes;

/// The smaller leave of the two grains.
EG_INLINE Batch least_of(std::span<const double> grains, const Index* i, const Index* j) {
  Batch least;
  for (std::size_t k = 0; k < lanes; ++k) least.v[k] = std::min(grains[i[k]], grains[j[k]]);
  return least;
}

void add_outgrown(const State& state, const Shifts& shift, const Mat<Batch>& rate, const Leave& leave, double time,
                  std::size_t c, std::vector<std::size_t>& found) {
  const auto& list = state.contacts;
  const Index *i = list.i.data() + c, *j = list.j.data() + c;
  BothSides<Batch> both;
  load_sides<false>(both, state.grains.position.data(), state.grains.velocity.data(), nullptr, i, j, shift.data(),
                    list.image.empty() ? nullptr : list.image.data() + c);
  const Vec<Batch> branch = xyz(both.branch);
  const Batch d2 = max(dot(branch, branch), Batch(1e-300)), inverse = rsqrt(d2);
  const Vec<Batch> velocity = xyz(both.velocity) + rate * branch;
  const Vec<Batch> n = branch * inverse;
  const Batch opening = dot(velocity, n), ahead = Batch(closing_margin * time);
  const Batch overlap = both.branch.w - d2 * inverse + max(-opening, Batch(0.0)) * ahead;
  const float* from = leave.bound.direction.data() + direction_place(c, 0);
  const Vec<Batch> counted{load_lanes(from), load_lanes(from + lanes), load_lanes(from + 2 * lanes)}, off = n - counted;
  // (a + b)² ≤ 2 (a² + b²), a how far it is off already, b how far it may yet turn
  const Batch onwards =
      max(dot(velocity, velocity) - opening * opening, Batch(0.0)) * (ahead * ahead * inverse * inverse);
  const Batch turn = least_of(leave.turn, list.i.data() + c, list.j.data() + c);
  const Mask over = (overlap > max(load_lanes(leave.bound.overlap.data() + c), Batch(0.0))) |
                    ((dot(counted, counted) > Batch(0.5)) & ((dot(off, off) + onwards) * Batch(2.0) > turn * turn));
  if (!any(over)) return;
  for (std::size_t k = 0; k < lanes; ++k)
    if (lane(over, k)) found.push_back(c + k);
}

}  // namespace

OverlapForecast forecast(const State& state, Index i, Index j, const Geometry<double>& g, double time) {
  const auto& velocity = state.grains.velocity;  // w: inverse mass
  const auto positive = [](double x) { return closing_margin * std::max(0.0, x); };
  double speed = 0, driven = 0, inverse_mass = velocity[i].w;
  if (j == no_index) {
    driven = positive(fastest_wall(state) + state.preparation.growth * state.grains.radius(i));
    speed = driven + positive(dot(velocity[i].vec(), g.n));
  } else {
    const double distance = state.grains.radius(i) + state.grains.radius(j) - g.overlap;
    const double affine = -dot(closing_gradient(state) * (g.n * distance), g.n);
    driven = positive(affine);
    speed = positive(affine - dot(velocity[j].vec() - velocity[i].vec(), g.n));
    inverse_mass += velocity[j].w;
  }
  return {speed * time, speed > 0 && inverse_mass > 0 ? speed * speed / inverse_mass : 0.0,
          std::min(speed, driven) * time};
}

double turn_forecast(const State& state, const ContactPoint& p, double time) {
  const auto& velocity = state.grains.velocity;
  if (p.j != no_index) {
    const Vec3 v = velocity[p.j].vec() - velocity[p.i].vec() + state.cell.rate * p.branch;
    return closing_margin * norm(v - p.geometry.n * dot(v, p.geometry.n)) * time / norm(p.branch);
  }
  const Wall& wall = state.walls[p.wall];
  if (wall.shape == Wall::plane && !wall.windowed()) return 0;
  return closing_margin * (norm(velocity[p.i].vec()) + fastest_wall(state)) * time / state.grains.radius(p.i);
}

std::vector<std::size_t> outgrown_pairs(const State& state, const Leave& leave, double time) {
  const auto& list = state.contacts;
  if (list.size() == 0) return {};
  Shifts shift;
  for (std::size_t c = 0; c < Cell::images; ++c) shift[c].set(state.cell.shift(static_cast<std::uint8_t>(c)));
  Mat<Batch> rate;
  const Mat3 gradient = closing_gradient(state);
  for (std::size_t k = 0; k < 9; ++k) rate.a[k] = Batch(gradient.a[k]);
  const std::size_t chunks = list.chunk_begin.size() - 1;
  std::vector<std::vector<std::size_t>> found(chunks);
#pragma omp parallel for schedule(static) if (chunks >= Contacts::worth_threads)
  for (std::size_t k = 0; k < chunks; ++k)
    for (std::size_t c = list.chunk_begin[k]; c < list.chunk_begin[k + 1]; c += Contacts::lanes)
      add_outgrown(state, shift, rate, leave, time, c, found[k]);
  for (std::size_t k = 1; k < chunks; ++k) found[0].insert(found[0].end(), found[k].begin(), found[k].end());
  return std::move(found[0]);
}

std::vector<std::size_t> outgrown_walls(const State& state, const Leave& leave, double time) {
  std::vector<std::size_t> found;
  for (std::size_t c = 0; c < state.wall_contacts.size(); ++c) {
    const auto& contact = state.wall_contacts[c];
    const Wall& wall = state.walls[contact.wall];
    const Quad& p = state.grains.position[contact.grain];
    const auto g = grain_surface(state, wall, p.vec(), p.w, Arms::surface);  // it may come into the window
    const Vec3 n = grain_wall(state, wall, p.vec(), p.w, Arms::surface).n, counted = leave.bound.wall_direction[c];
    ContactPoint at;
    at.i = contact.grain, at.j = no_index, at.wall = contact.wall;
    const bool turned = norm(counted) > 0 && norm(n - counted) + turn_forecast(state, at, time) > leave.turn[at.i];
    if (turned || g.overlap + forecast(state, contact.grain, no_index, g, time).growth > leave.bound.wall_overlap[c])
      found.push_back(c);
  }
  return found;
}

}  // namespace eg
