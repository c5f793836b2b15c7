#include "dynamics/integrate.hpp"

#include <algorithm>
#include <cmath>

namespace eg {
namespace {

constexpr std::size_t chunk = Contacts::chunk;

std::size_t chunks_of(std::size_t n) { return (n + chunk - 1) / chunk; }

Double4& vector(Quad& q) { return *reinterpret_cast<Double4*>(&q); }
const Double4& vector(const Quad& q) { return *reinterpret_cast<const Double4*>(&q); }
double dot3(Double4 a, Double4 b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// −α|F| sign(v), sign(0) = 0 (Cundall 1987).
EG_INLINE Double4 local_force(Double4 f, Double4 v, double alpha) {
  const Double4 size = f < 0.0 ? -f : f;
  const Double4 against = v > 0.0 ? -size : size;
  return (v == 0.0 ? Double4{} : against) * alpha;
}

/// Row i plus its halo rows, quad by quad.
EG_INLINE Double4 gather_quad(const ForceWorkspace& work, std::size_t i, std::size_t offset) {
  const Schedule& s = work.schedule;
  Double4 sum = vector(work.rows[i * work.stride + offset]);
  for (Index h = s.gather_begin[i]; h < s.gather_begin[i + 1]; ++h)
    sum += vector(work.rows[s.gather_row[h] * work.stride + offset]);
  return sum;
}

struct Columns4 {
  Double4 x, y, z;
};
Columns4 columns(const Mat3& m) {
  return {Double4{m(0, 0), m(1, 0), m(2, 0), 0}, Double4{m(0, 1), m(1, 1), m(2, 1), 0},
          Double4{m(0, 2), m(1, 2), m(2, 2), 0}};
}
EG_INLINE Double4 times(const Columns4& m, Double4 v) { return m.x * v[0] + m.y * v[1] + m.z * v[2]; }

/// Leaves w (inverse mass or inertia) as it is.
EG_INLINE void move3(Double4& q, Double4 change) {
  change[3] = 0;
  q += change;
}

/// One grain: c or ω by its force or moment. `works` adds up energies.
template <bool works>
EG_INLINE void kick_one(Double4& velocity, Double4 force, double dt, double local, double drag, const Columns4* affine,
                        Double4 gravity, KickSums& sums) {
  const double inverse = velocity[3];
  if (!(inverse > 0)) return;
  const Double4 before = velocity;
  Double4 rate = force * inverse + gravity;  // acceleration by contacts and weight
  const Double4 damping = local > 0 ? local_force(rate, before, local) : Double4{};
  Double4 rest = before * -drag;
  if (affine) rest -= times(*affine, before);
  move3(velocity, (rate + damping + rest) * dt);
  if constexpr (works) {
    const double mass = 1 / inverse;
    const Double4 path = (before + velocity) * (0.5 * dt * mass);  // times acceleration: work
    sums.kinetic += 0.5 * mass * dot3(before, velocity);
    sums.local_damping -= dot3(damping, path), sums.mass_damping += drag * dot3(before, path);
    sums.body += dot3(gravity, path);
    if (affine) {  // a velocity, not a spin
      sums.affine -= dot3(times(*affine, before), path);
      sums.unbalanced += mass * std::sqrt(dot3(rate, rate));
    }
  }
}

template <bool works>
KickSums kick_chunk(State& state, const ForceWorkspace& work, std::size_t low, std::size_t high, double dt,
                    const KickOptions& options) {
  auto& g = state.grains;
  const Columns4 affine = columns(state.cell.rate);
  const Double4 gravity{options.gravity.x, options.gravity.y, options.gravity.z, 0};
  const bool moments = g.rotates() && work.stride == 2;
  KickSums sums;
  for (std::size_t i = low; i < high; ++i) {
    kick_one<works>(vector(g.velocity[i]), gather_quad(work, i, 0), dt, options.local, options.mass, &affine, gravity,
                    sums);
    if (moments)
      kick_one<works>(vector(g.spin[i]), gather_quad(work, i, 1), dt, options.local, options.mass, nullptr, Double4{},
                      sums);
  }
  return sums;
}

}  // namespace

KickSums& KickSums::operator+=(const KickSums& b) {
  kinetic += b.kinetic, local_damping += b.local_damping, mass_damping += b.mass_damping;
  body += b.body, affine += b.affine, unbalanced += b.unbalanced;
  return *this;
}

double drift(State& state, double dt) {
  auto& g = state.grains;
  const Columns4 l = columns(state.cell.rate);
  state.cell.deform(dt);
  state.cell.origin += (state.cell.rate * state.cell.origin) * dt;
  const Columns4 f = columns(state.cell.h * inverse(state.list.reference_cell));
  std::vector<double> largest(chunks_of(g.size()), 0.0);
#pragma omp parallel for schedule(static) if (largest.size() >= Contacts::worth_threads)
  for (std::size_t k = 0; k < largest.size(); ++k) {
    double most = 0;
    for (std::size_t i = k * chunk; i < std::min(g.size(), (k + 1) * chunk); ++i) {
      Double4& x = vector(g.position[i]);
      move3(x, (vector(g.velocity[i]) + times(l, x)) * dt);
      const Vec3& start = state.list.reference[i];
      const Double4 u = x - (f.x * start.x + f.y * start.y + f.z * start.z);
      most = std::max(most, dot3(u, u));
    }
    largest[k] = most;
  }
  for (auto& w : state.walls) {
    w.point += w.velocity * dt;
    w.moved += std::abs(dot(w.velocity, w.normal)) * dt;
  }
  return largest.empty() ? 0.0 : std::sqrt(*std::max_element(largest.begin(), largest.end()));
}

KickSums kick(State& state, const ForceWorkspace& work, double dt, const KickOptions& options, bool works) {
  const std::size_t n = state.grains.size();
  std::vector<KickSums> sums(chunks_of(n));
#pragma omp parallel for schedule(static) if (sums.size() >= Contacts::worth_threads)
  for (std::size_t k = 0; k < sums.size(); ++k) {
    const std::size_t low = k * chunk, high = std::min(n, low + chunk);
    sums[k] = works ? kick_chunk<true>(state, work, low, high, dt, options)
                    : kick_chunk<false>(state, work, low, high, dt, options);
  }
  KickSums total;
  for (const auto& s : sums) total += s;
  return total;
}

}  // namespace eg
