#include "timestep/outgrown.hpp"

#include <algorithm>

#include "contact/interaction.hpp"
#include "contact/lanes.hpp"
#include "state/wall_geometry.hpp"

namespace eg {
namespace {

double fastest(const State& state) {
  double speed = 0;
  for (const auto& b : state.bodies) speed = std::max(speed, norm(b.velocity) + std::abs(b.opening));
  return speed;
}

constexpr std::size_t lanes = Contacts::lanes;

/// The smaller leave of the two grains.
EG_INLINE Batch least_of(std::span<const double> grains, const Index* i, const Index* j) {
  Batch least;
  for (std::size_t k = 0; k < lanes; ++k) least.v[k] = std::min(grains[i[k]], grains[j[k]]);
  return least;
}

void add_outgrown(const State& state, const CommonMotion& motion, const Mat<Batch>& rate, const Leave& leave,
                  double time, std::size_t c, std::vector<std::size_t>& found) {
  const auto& list = state.contacts;
  const Index *i = list.i.data() + c, *j = list.j.data() + c;
  BothSides<Batch> both;
  load_sides<false>(both, state.grains.position.data(), state.grains.velocity.data(), nullptr, i, j,
                    motion.shift.data(), list.image.empty() ? nullptr : list.image.data() + c);
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

std::vector<std::size_t> outgrown_pairs(const State& state, const Leave& leave, double time) {
  const auto& list = state.contacts;
  if (list.size() == 0) return {};
  const CommonMotion motion(state);
  Mat<Batch> rate;
  for (std::size_t k = 0; k < 9; ++k) rate.a[k] = Batch(motion.closing.a[k]);
  const std::size_t chunks = list.chunk_begin.size() - 1;
  std::vector<std::vector<std::size_t>> found(chunks);
#pragma omp parallel for schedule(static) if (chunks >= Contacts::worth_threads)
  for (std::size_t k = 0; k < chunks; ++k)
    for (std::size_t c = list.chunk_begin[k]; c < list.chunk_begin[k + 1]; c += Contacts::lanes)
      add_outgrown(state, motion, rate, leave, time, c, found[k]);
  for (std::size_t k = 1; k < chunks; ++k) found[0].insert(found[0].end(), found[k].begin(), found[k].end());
  return std::move(found[0]);
}

std::vector<std::size_t> outgrown_walls(const State& state, const Leave& leave, double time) {
  const CommonMotion motion(state);
  std::vector<std::size_t> found;
  for (std::size_t c = 0; c < state.wall_contacts.size(); ++c) {
    const auto& contact = state.wall_contacts[c];
    const Wall& wall = state.walls[contact.wall];
    const Quad& p = state.grains.position[contact.grain];
    const auto g = grain_surface(state, wall, p.vec(), p.w, Arms::surface);  // it may come into the window
    const Vec3 n = grain_wall(state, wall, p.vec(), p.w, Arms::surface).n, counted = leave.bound.wall_direction[c];
    const auto approach = motion.at_wall(state, contact, g.n);
    const double off = norm(n - counted) + approach.turning * time;
    if ((norm(counted) > 0 && off > leave.turn[contact.grain]) ||
        g.overlap + approach.speed * time > leave.bound.wall_overlap[c])
      found.push_back(c);
  }
  return found;
}

}  // namespace eg
