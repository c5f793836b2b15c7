#pragma once
// Where a grain meets a wall, for every number type: the one place that knows the shapes.
#include "contact/interaction.hpp"
#include "state/state.hpp"

namespace eg {

inline double plain(double x) { return x; }
template <std::size_t N>
double plain(const Dual<N>& x) {
  return x.v;
}
template <class S>
Vec3 plain(const Vec<S>& x) {
  return {plain(x.x), plain(x.y), plain(x.z)};
}
template <class S>
Vec<S> lift(const Vec3& v) {
  return {S(v.x), S(v.y), S(v.z)};
}

/// n points into the wall.
template <class S>
Geometry<S> against(const Vec<S>& n, const S& overlap, const S& radius, Arms arms) {
  const S shorten = arms == Arms::middle ? S(0.5) * overlap : S(0.0);
  return {n, overlap, shorten, radius - shorten, S(0.0)};
}

template <class S>
Geometry<S> apart(const Wall& wall, const S& radius, Arms arms) {
  return against(lift<S>(wall.normal), -radius, radius, arms);
}

/// A line along wall.normal through `point`; `hollow`: a grain inside a cylinder about it, else outside.
template <class S>
Geometry<S> grain_line(const Wall& wall, const Vec<S>& from, const S& radius, bool hollow, Arms arms) {
  using std::sqrt;
  const Vec<S> axis = lift<S>(wall.normal), across = from - axis * dot(from, axis);
  const S distance = sqrt(max(dot(across, across), S(1e-300)));
  const Vec<S> outward = across * (S(1.0) / distance);
  return hollow ? against(outward, distance + radius - S(wall.radius), radius, arms)
                : against(-outward, S(wall.radius) + radius - distance, radius, arms);
}

/// Whether the foot of x on the plane of a face lies within it. Neighbours in one plane find the same number for their
/// common edge, so that a grain exactly over it belongs to one of them.
bool over_face(const Wall& face, const Vec3& x);
/// Whether a rim or tip is nearer to x than any face or rim that it is the border of.
bool off_rim(const Wall& rim, const Vec3& x);
bool off_tip(const Wall& tip, const std::vector<Vec3>& spokes, const Vec3& x);

template <class S>
Geometry<S> grain_mesh(const State& state, const Wall& wall, const Vec<S>& x, const S& radius, Arms arms) {
  using std::sqrt;
  const Vec<S> from = x - lift<S>(wall.point);
  if (wall.shape == Wall::face) {
    const Vec<S> normal = lift<S>(wall.normal);
    const S height = dot(from, normal);  // further behind, another side of the body is meant
    return height > -radius && over_face(wall, plain(x)) ? grain_plane(height, normal, radius, arms)
                                                         : apart<S>(wall, radius, arms);
  }
  if (wall.shape == Wall::rim)
    return off_rim(wall, plain(x)) ? grain_line(wall, from, radius, false, arms) : apart<S>(wall, radius, arms);
  if (!off_tip(wall, state.spokes, plain(x))) return apart<S>(wall, radius, arms);
  const S distance = sqrt(max(dot(from, from), S(1e-300)));
  return against(from * (S(-1.0) / distance), radius - distance, radius, arms);
}

/// The surface as if all of it were there, whatever its window.
template <class S>
Geometry<S> grain_surface(const State& state, const Wall& wall, const Vec<S>& x, const S& radius, Arms arms) {
  if (wall.shape == Wall::plane) {
    const Vec<S> normal = lift<S>(wall.normal);
    return grain_plane(dot(x - lift<S>(wall.point), normal), normal, radius, arms);
  }
  if (wall.shape == Wall::cylinder) return grain_line(wall, x - lift<S>(wall.point), radius, wall.hollow, arms);
  return grain_mesh(state, wall, x, radius, arms);
}

/// Where the centre stands to the wall's window: 0 within, > 0 so far above it, < 0 so far below [m].
inline double off_window(const Wall& wall, const Vec3& x) {
  if (!wall.windowed()) return 0;
  const double s = dot(x - wall.point, wall.along);
  return s < wall.low ? s - wall.low : s >= wall.high ? s - wall.high : 0;
}

/// Beside its window a wall ends in a ledge: behind its surface a grain rests on that, before it on the corner.
template <class S>
Geometry<S> grain_ledge(const Wall& wall, const Geometry<S>& surface, const Vec<S>& x, const S& radius, bool above,
                        Arms arms) {
  using std::sqrt;
  const Vec<S> out = lift<S>(above ? wall.along : -wall.along);
  const S off = dot(x - lift<S>(wall.point), out) - S(above ? wall.high : -wall.low), before = radius - surface.overlap;
  if (!(before > S(0.0))) return against(-out, radius - off, radius, arms);
  const S distance = sqrt(max(off * off + before * before, S(1e-300)));
  const Vec<S> to_corner = surface.n * before - out * off;
  return against(to_corner * (S(1.0) / distance), radius - distance, radius, arms);
}

/// `x`: the grain's centre.
template <class S>
Geometry<S> grain_wall(const State& state, const Wall& wall, const Vec<S>& x, const S& radius, Arms arms) {
  const double off = off_window(wall, plain(x));
  if (off == 0) return grain_surface(state, wall, x, radius, arms);
  if (std::abs(off) >= plain(radius)) return apart<S>(wall, radius, arms);
  return grain_ledge(wall, grain_surface(state, wall, x, radius, Arms::surface), x, radius, off > 0, arms);
}

/// Unit vector from the axis of a cylinder to x; zero for other shapes.
inline Vec3 radial(const Wall& wall, const Vec3& x) {
  if (wall.shape != Wall::cylinder) return {};
  const Vec3 from = x - wall.point, across = from - wall.normal * dot(from, wall.normal);
  return across * (1 / std::max(norm(across), 1e-300));
}

}  // namespace eg
