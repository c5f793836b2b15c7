#include "report/rose_chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "report/canvas.hpp"

namespace eg {

namespace {

constexpr double page = 420, reach = 150;  ///< [pt]
constexpr Point middle{page / 2, 232};
constexpr Colour ink{0.13, 0.13, 0.15}, grid{0.72, 0.72, 0.75}, faint{0.42, 0.42, 0.46}, petal{0.36, 0.58, 0.78};

double longest(const RoseChart& chart) {
  double most = 0;
  for (const auto& p : chart.petals) most = std::max(most, p.value);
  return most;
}

Point around(double angle, double radius) {
  return {middle.x + radius * std::cos(angle), middle.y - radius * std::sin(angle)};
}

void circle(Canvas& canvas, double radius, const Pen& pen) {
  std::vector<Point> points;
  for (int k = 0; k <= 120; ++k) points.push_back(around(k * std::numbers::pi / 60, radius));
  canvas.stroke(points, pen);
}

void draw_flat(Canvas& canvas, const RoseChart& chart) {
  const double most = std::max(1.0, longest(chart)), scale = reach / most;
  for (const auto& p : chart.petals) {
    std::vector<Point> corners{middle};
    for (int k = 0; k <= 8; ++k)
      corners.push_back(around(p.azimuth_from + k * (p.azimuth_to - p.azimuth_from) / 8, p.value * scale));
    canvas.polygon(corners, petal);
    corners.push_back(middle);
    canvas.stroke(corners, {ink, 0.5});
  }
  circle(canvas, scale, {faint, 1, Dash::dashed});
  for (const double angle : {0.0, std::numbers::pi / 2})
    canvas.stroke(std::array{around(angle, reach + 12), around(angle + std::numbers::pi, reach + 12)}, {grid, 0.7});
  canvas.text(around(0, reach + 22), "x", {.size = 10.5, .colour = ink, .align = Align::centre});
  canvas.text(around(std::numbers::pi / 2, reach + 22), "y", {.size = 10.5, .colour = ink, .align = Align::centre});
  canvas.text({page / 2, page - 16}, fmt::format("{}; dashed: 1, longest: {:.3g}", chart.value, most),
              {.size = 9.5, .colour = ink, .align = Align::centre});
}

/// A direction in space and on the page.
struct View {
  struct Place {
    double right = 0, up = 0, near = 0;
  };
  static Place see(double x, double y, double z) {
    constexpr double turn = -std::numbers::pi / 3, tilt = 0.35;  // the viewer stands at this azimuth, this far up
    const double along = x * std::cos(turn) + y * std::sin(turn), across = -x * std::sin(turn) + y * std::cos(turn);
    return {across, z * std::cos(tilt) - along * std::sin(tilt), along * std::cos(tilt) + z * std::sin(tilt)};
  }
};

struct Face {
  std::vector<View::Place> corners;
  double value = 0;

  /// Cosine of the angle between its normal and the viewer; ≤ 0 seen from behind. Corners run against the clock.
  double facing() const {
    const auto &a = corners[0], &b = corners[1], &c = corners[2];
    const double ux = b.right - a.right, uy = b.up - a.up, uz = b.near - a.near;
    const double vx = c.right - a.right, vy = c.up - a.up, vz = c.near - a.near;
    const double x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
    const double size = std::sqrt(x * x + y * y + z * z);
    return size > 0 ? z / size : 0;
  }
};

double nearness(const RosePetal& p) {
  const double azimuth = (p.azimuth_from + p.azimuth_to) / 2, height = (p.height_from + p.height_to) / 2;
  const double flat = std::sqrt(1 - height * height);
  return View::see(flat * std::cos(azimuth), flat * std::sin(azimuth), height).near;
}

/// The cap and the four sides of a spike.
void add_spike(std::vector<Face>& faces, const RosePetal& p) {
  const auto corner = [&](double azimuth, double height) {
    const double flat = std::sqrt(std::max(0.0, 1 - height * height));
    return View::see(p.value * flat * std::cos(azimuth), p.value * flat * std::sin(azimuth), p.value * height);
  };
  const std::array rim{corner(p.azimuth_from, p.height_from), corner(p.azimuth_to, p.height_from),
                       corner(p.azimuth_to, p.height_to), corner(p.azimuth_from, p.height_to)};
  const bool from_below = p.height_from <= -1;  // two corners coincide at a pole; the first three must span the cap
  faces.push_back({from_below ? std::vector{rim[0], rim[2], rim[3]} : std::vector(rim.begin(), rim.end()), p.value});
  for (std::size_t k = 0; k < 4; ++k) faces.push_back({{View::Place{}, rim[(k + 1) % 4], rim[k]}, p.value});
}

/// Light blue to dark red by value, darker where turned away.
Colour shade(double share, double facing) {
  const double light = 0.55 + 0.45 * facing;
  const double red = 0.75 + 0.1 * share, green = 0.85 - 0.65 * share, blue = 0.95 - 0.8 * share;
  return {red * light, green * light, blue * light};
}

void draw_axes(Canvas& canvas, double scale, double length) {
  const std::array<std::pair<const char*, std::array<double, 3>>, 3> axes{
      {{"x", {length, 0, 0}}, {"y", {0, length, 0}}, {"z", {0, 0, length}}}};
  for (const auto& [name, d] : axes) {
    const auto tip = View::see(d[0], d[1], d[2]), label = View::see(1.07 * d[0], 1.07 * d[1], 1.07 * d[2]);
    canvas.stroke(std::array{middle, Point{middle.x + scale * tip.right, middle.y - scale * tip.up}}, {faint, 1});
    canvas.text({middle.x + scale * label.right, middle.y - scale * label.up}, name,
                {.size = 10.5, .colour = ink, .align = Align::centre});
  }
}

void draw_solid(Canvas& canvas, const RoseChart& chart) {
  const double most = std::max(1.0, longest(chart)), scale = reach / most;
  std::vector<Face> faces;
  std::vector<RosePetal> petals = chart.petals;  // a body that its centre sees all of: farther directions lie behind
  std::ranges::sort(petals, {}, nearness);
  for (const auto& p : petals)
    if (p.value > 0) add_spike(faces, p);
  draw_axes(canvas, scale, 1.15 * most);
  for (const auto& f : faces) {
    const double facing = f.facing();
    if (facing <= 0) continue;
    std::vector<Point> corners;
    for (const auto& c : f.corners) corners.push_back({middle.x + scale * c.right, middle.y - scale * c.up});
    canvas.polygon(corners, shade(f.value / most, facing));
  }
  constexpr double left = 120, width = 180, y = page - 34;
  for (int k = 0; k < 60; ++k)
    canvas.rectangle({left + k * width / 60, y}, {left + (k + 1) * width / 60 + 0.3, y + 8}, shade(k / 59.0, 1));
  canvas.text({left - 6, y + 4}, "0", {.size = 9.5, .colour = ink, .align = Align::right});
  canvas.text({left + width + 6, y + 4}, fmt::format("{:.3g}", most), {.size = 9.5, .colour = ink});
  canvas.text({page / 2, page - 14}, chart.value, {.size = 9.5, .colour = ink, .align = Align::centre});
}

}  // namespace

void write_rose(const RoseChart& chart, const std::filesystem::path& path) {
  Canvas canvas(path, page, page);
  canvas.headings(16, chart.title, chart.subtitle);
  if (chart.solid)
    draw_solid(canvas, chart);
  else
    draw_flat(canvas, chart);
  canvas.save();
}

}  // namespace eg
