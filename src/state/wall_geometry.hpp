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

/// Whether the centre is in the wall's window, widened by `margin` [m].
inline bool in_window(const Wall& wall, const Vec3& x, double margin = 0) {
  if (!wall.windowed()) return true;
  const double s = dot(x - wall.point, wall.along);
  return s >= wall.low - margin && s < wall.high + margin;
}

/// `x`: the grain's centre. Outside the window nothing touches.
template <class S>
Geometry<S> grain_wall(const State& state, const Wall& wall, const Vec<S>& x, const S& radius, Arms arms) {
  return in_window(wall, plain(x)) ? grain_surface(state, wall, x, radius, arms) : apart<S>(wall, radius, arms);
}

/// Outward along the radius at a contact whose normal is n (zero for other shapes than cylinders).
inline Vec3 radial(const Wall& wall, const Vec3& n) {
  if (wall.shape != Wall::cylinder) return {};
  return wall.hollow ? n : -n;
}

}  // namespace eg
