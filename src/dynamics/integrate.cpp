#include "dynamics/integrate.hpp"

#include <algorithm>
#include <cmath>

namespace eg {
namespace {

constexpr std::size_t chunk = Contacts::chunk;

Double4& vector(Quad& q) { return *reinterpret_cast<Double4*>(&q); }

// A row is one quad (velocity), or two side by side (velocity | spin): V is Double4 or Double8.
EG_INLINE Double4 spread(Double4 v, std::integral_constant<int, 0>) {
  return __builtin_shufflevector(v, v, 0, 0, 0, 0);
}
EG_INLINE Double4 spread(Double4 v, std::integral_constant<int, 1>) {
  return __builtin_shufflevector(v, v, 1, 1, 1, 1);
}
EG_INLINE Double4 spread(Double4 v, std::integral_constant<int, 2>) {
  return __builtin_shufflevector(v, v, 2, 2, 2, 2);
}
EG_INLINE Double4 spread(Double4 v, std::integral_constant<int, 3>) {
  return __builtin_shufflevector(v, v, 3, 3, 3, 3);
}
template <int k>
EG_INLINE Double8 spread(Double8 v, std::integral_constant<int, k>) {
  return __builtin_shufflevector(v, v, k, k, k, k, k + 4, k + 4, k + 4, k + 4);
}
template <int k, class V>
EG_INLINE V spread(V v) {
  return spread(v, std::integral_constant<int, k>{});
}
EG_INLINE double total(Double4 v) { return v[0] + v[1] + v[2]; }
EG_INLINE double total(Double8 v) { return (v[0] + v[1] + v[2]) + (v[4] + v[5] + v[6]); }

template <class V>
EG_INLINE V row_of(double x, double y, double z) {
  V v{};
  v[0] = x, v[1] = y, v[2] = z;
  return v;
}

/// Columns of L for the velocity half of a row; zero for the spin half.
template <class V>
struct Affine {
  V x, y, z;
  explicit Affine(const Mat3& m)
      : x(row_of<V>(m(0, 0), m(1, 0), m(2, 0))),
        y(row_of<V>(m(0, 1), m(1, 1), m(2, 1))),
        z(row_of<V>(m(0, 2), m(1, 2), m(2, 2))) {}
  EG_INLINE V operator*(V v) const { return x * spread<0>(v) + y * spread<1>(v) + z * spread<2>(v); }
};

/// −α|F| sign(v), sign(0) = 0 (Cundall 1987).
template <class V>
EG_INLINE V local_force(V f, V v, double alpha) {
  const V size = f < 0.0 ? -f : f;
  const V against = v > 0.0 ? -size : size;
  return (v == 0.0 ? V{} : against) * alpha;
}

/// c and ω of one grain by its force and moment. `works` adds up energies.
template <bool works, class V>
EG_INLINE V kicked(V before, V force, double dt, const KickOptions& options, const Affine<V>& affine, V gravity,
                   KickSums& sums) {
  const V inverse = spread<3>(before);
  const V rate = force * inverse + gravity;  // acceleration by contacts and weight
  const V damping = options.local > 0 ? local_force(rate, before, options.local) : V{};
  const V bent = affine * before;
  V change = (rate + damping - before * options.mass - bent) * dt;
  change = inverse > 0.0 ? change : V{};  // fixed grains
  change[3] = 0;                          // 1/m and 1/I stay
  if constexpr (sizeof(V) == sizeof(Double8)) change[7] = 0;
  const V after = before + change;
  if constexpr (works) {
    const V mass = inverse > 0.0 ? 1.0 / inverse : V{};
    const V path = (before + after) * (0.5 * dt) * mass;  // times acceleration: work
    sums.kinetic += total(0.5 * mass * before * after);
    sums.local_damping -= total(damping * path), sums.mass_damping += options.mass * total(before * path);
    sums.body += total(gravity * path), sums.affine -= total(bent * path);
    sums.unbalanced += mass[0] * std::sqrt(rate[0] * rate[0] + rate[1] * rate[1] + rate[2] * rate[2]);
  }
  return after;
}

template <bool works, class V>
KickSums kick_rows(State& state, ForceWorkspace& work, std::size_t k, double dt, const KickOptions& options) {
  constexpr bool turning = sizeof(V) == sizeof(Double8);
  auto& g = state.grains;
  const std::size_t low = k * chunk, high = std::min(g.size(), low + chunk);
  const auto row = [&](std::size_t r) -> V& {
    return *reinterpret_cast<V*>(&work.rows[r * (sizeof(V) / sizeof(Quad))]);
  };
  const Schedule& s = work.schedule;
  for (Index e = s.gather_begin[k]; e < s.gather_begin[k + 1]; ++e) {
    row(s.gather_grain[e]) += row(s.gather_row[e]);
    row(s.gather_row[e]) = V{};
  }
  const Affine<V> affine(state.cell.rate);
  const V gravity = row_of<V>(options.gravity.x, options.gravity.y, options.gravity.z);
  KickSums sums;
  for (std::size_t i = low; i < high; ++i) {
    if constexpr (turning) {
      const V after =
          kicked<works, V>(join(vector(g.velocity[i]), vector(g.spin[i])), row(i), dt, options, affine, gravity, sums);
      vector(g.velocity[i]) = __builtin_shufflevector(after, after, 0, 1, 2, 3);
      vector(g.spin[i]) = __builtin_shufflevector(after, after, 4, 5, 6, 7);
    } else {
      vector(g.velocity[i]) = kicked<works, V>(vector(g.velocity[i]), row(i), dt, options, affine, gravity, sums);
    }
    row(i) = V{};
  }
  return sums;
}

}  // namespace

KickSums& KickSums::operator+=(const KickSums& b) {
  kinetic += b.kinetic, local_damping += b.local_damping, mass_damping += b.mass_damping;
  body += b.body, affine += b.affine, unbalanced += b.unbalanced;
  return *this;
}

/// A plane without a window may slide along itself without coming nearer to any grain.
static void move_bodies(State& state, double dt) {
  for (auto& body : state.bodies) body.moved += body.velocity * dt, body.opened += body.opening * dt;
  for (auto& w : state.walls) {
    const Body& body = state.bodies[w.body];
    w.point += body.velocity * dt;
    const bool slides = w.shape == Wall::plane && !w.windowed();
    double way = slides ? std::abs(dot(body.velocity, w.normal)) : norm(body.velocity);
    if (w.shape == Wall::cylinder) w.radius += body.opening * dt, way += std::abs(body.opening);
    w.moved += way * dt;
  }
}

void drift(State& state, double dt, Blocks& blocks) {
  auto& g = state.grains;
  const Mat3 stretch = state.cell.deform(dt);
  const Affine<Double4> l(stretch);
  state.cell.origin += stretch * state.cell.origin;
#pragma omp parallel for schedule(static) if (g.size() >= Contacts::worth_threads * chunk)
  for (std::size_t b = 0; b < blocks.count(); ++b) {
    Double4 low = Double4{} + INFINITY, high = Double4{} - INFINITY;
    for (std::size_t i = blocks.begin(b); i < blocks.end(b, g.size()); ++i) {
      Double4& x = vector(g.position[i]);
      const Double4 v = vector(g.velocity[i]);
      Double4 change = v * dt + l * x;
      change[3] = 0;
      x += change;
      low = v < low ? v : low, high = v > high ? v : high;
    }
    low[3] = high[3] = 0;
    blocks.move(b, low * dt, high * dt);
  }
  blocks.deform(state.cell.rate, dt);
  move_bodies(state, dt);
}

void kick_chunk(State& state, ForceWorkspace& work, std::size_t k, double dt, const KickOptions& options, bool works) {
  const auto run = [&]<class V>(V) {
    work.kick_sums[k] =
        works ? kick_rows<true, V>(state, work, k, dt, options) : kick_rows<false, V>(state, work, k, dt, options);
  };
  work.stride == 2 ? run(Double8{}) : run(Double4{});
}

KickSums kick_bodies(State& state, double dt, const KickOptions& options) {
  KickSums sums;
  for (auto& body : state.bodies)
    for (int k = 0; k < 3; ++k) {
      if (!body.free[static_cast<std::size_t>(k)]) continue;
      const double before = body.velocity[k], rate = body.force[k] / body.mass;
      const double sign = before > 0 ? 1.0 : before < 0 ? -1.0 : 0.0;
      const double damping = -options.local * std::abs(rate) * sign;
      body.velocity[k] += (rate + damping - options.mass * before) * dt;
      const double path = 0.5 * (before + body.velocity[k]) * dt * body.mass;
      sums.kinetic += 0.5 * body.mass * before * body.velocity[k];
      sums.local_damping -= damping * path, sums.mass_damping += options.mass * before * path;
    }
  return sums;
}

}  // namespace eg
