#include "dynamics/integrate.hpp"

#include <algorithm>
#include <cmath>

namespace eg {
namespace {

constexpr std::size_t chunk = Contacts::chunk;

std::size_t chunks_of(std::size_t n) { return (n + chunk - 1) / chunk; }

/// −α|F| sign(v) (Cundall 1987).
Vec3 local_force(const Vec3& f, const Vec3& v, double alpha) {
  const auto one = [alpha](double force, double speed) {
    return speed == 0 ? 0.0 : -alpha * std::abs(force) * std::copysign(1.0, speed);
  };
  return {one(f.x, v.x), one(f.y, v.y), one(f.z, v.z)};
}

}  // namespace

KickSums& KickSums::operator+=(const KickSums& b) {
  kinetic += b.kinetic, local_damping += b.local_damping, mass_damping += b.mass_damping;
  body += b.body, affine += b.affine, unbalanced += b.unbalanced;
  return *this;
}

double drift(State& state, double dt) {
  auto& g = state.grains;
  const Mat3 l = state.cell.rate;
  state.cell.deform(dt);
  state.cell.origin += (l * state.cell.origin) * dt;
  const Mat3 f = state.cell.h * inverse(state.list.reference_cell);
  std::vector<double> largest(chunks_of(g.size()), 0.0);
#pragma omp parallel for schedule(static) if (largest.size() > 1)
  for (std::size_t k = 0; k < largest.size(); ++k) {
    double most = 0;
    for (std::size_t i = k * chunk; i < std::min(g.size(), (k + 1) * chunk); ++i) {
      const Vec3 x = g.position[i].vec();
      const Vec3 moved = x + (g.velocity[i].vec() + l * x) * dt;
      g.position[i].set(moved);
      const Vec3 u = moved - f * state.list.reference[i];
      most = std::max(most, dot(u, u));
    }
    largest[k] = most;
  }
  for (auto& w : state.walls) {
    w.point += w.velocity * dt;
    w.moved += std::abs(dot(w.velocity, w.normal)) * dt;
  }
  return largest.empty() ? 0.0 : std::sqrt(*std::max_element(largest.begin(), largest.end()));
}

KickSums kick(State& state, const ForceWorkspace& work, double dt, const KickOptions& options) {
  auto& g = state.grains;
  const Mat3 l = state.cell.rate;
  std::vector<KickSums> sums(chunks_of(g.size()));
#pragma omp parallel for schedule(static) if (sums.size() > 1)
  for (std::size_t k = 0; k < sums.size(); ++k) {
    KickSums s;
    for (std::size_t i = k * chunk; i < std::min(g.size(), (k + 1) * chunk); ++i) {
      const ForceRow row = gather_row(work, i);
      const double inverse_mass = g.velocity[i].w;
      if (inverse_mass > 0) {
        const double m = 1 / inverse_mass;
        const Vec3 before = g.velocity[i].vec();
        const Vec3 weight = options.gravity * m;
        const Vec3 net = row.force.vec() + weight;
        const Vec3 local = local_force(net, before, options.local);
        const Vec3 drag = before * (-options.mass * m);
        const Vec3 affine = (l * before) * -m;
        const Vec3 after = before + (net + local + drag + affine) * (dt * inverse_mass);
        g.velocity[i].set(after);
        const Vec3 path = (before + after) * (0.5 * dt);
        s.kinetic += 0.5 * m * dot(before, after);
        s.local_damping -= dot(local, path), s.mass_damping -= dot(drag, path);
        s.body += dot(weight, path), s.affine += dot(affine, path);
        s.unbalanced += norm(net);
      }
      if (!g.rotates()) continue;
      const double inverse_inertia = g.spin[i].w;
      if (!(inverse_inertia > 0)) continue;
      const double inertia = 1 / inverse_inertia;
      const Vec3 before = g.spin[i].vec(), moment = row.moment.vec();
      const Vec3 local = local_force(moment, before, options.local);
      const Vec3 drag = before * (-options.mass * inertia);
      const Vec3 after = before + (moment + local + drag) * (dt * inverse_inertia);
      g.spin[i].set(after);
      const Vec3 path = (before + after) * (0.5 * dt);
      s.kinetic += 0.5 * inertia * dot(before, after);
      s.local_damping -= dot(local, path), s.mass_damping -= dot(drag, path);
    }
    sums[k] = s;
  }
  KickSums total;
  for (const auto& s : sums) total += s;
  return total;
}

}  // namespace eg
