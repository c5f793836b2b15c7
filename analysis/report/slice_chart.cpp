#include "report/slice_chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "report/ticks.hpp"

namespace eg {

namespace {

constexpr Colour ink{0.13, 0.13, 0.15}, faint{0.42, 0.42, 0.46}, outline{0.72, 0.72, 0.75}, grain{0.955, 0.955, 0.96};
constexpr Colour plain{0.25, 0.42, 0.62}, marked{0.75, 0.12, 0.1};
constexpr double left = 66, top = 52, beneath = 66, longest_side = 470, widest_line = 5.5;  ///< [pt]

/// Places on the page.
struct Frame {
  double scale, x_low, y_high, right, bottom;

  explicit Frame(const SliceChart& c)
      : scale(longest_side / std::max(c.x_high - c.x_low, c.y_high - c.y_low)),
        x_low(c.x_low),
        y_high(c.y_high),
        right(left + scale * (c.x_high - c.x_low)),
        bottom(top + scale * (c.y_high - c.y_low)) {}
  Point operator()(double x, double y) const { return {left + scale * (x - x_low), top + scale * (y_high - y)}; }
};

std::vector<Point> circle(const Point& centre, double radius) {
  const int corners = std::clamp(static_cast<int>(4 * std::sqrt(radius)) + 8, 10, 48);
  std::vector<Point> points;
  for (int k = 0; k <= corners; ++k) {
    const double angle = 2 * std::numbers::pi * k / corners;
    points.push_back({centre.x + radius * std::cos(angle), centre.y + radius * std::sin(angle)});
  }
  return points;
}

void draw_disks(Canvas& canvas, const Frame& frame, const SliceChart& chart) {
  for (const auto& d : chart.disks) {
    const auto ring = circle(frame(d.x, d.y), frame.scale * d.radius);
    canvas.polygon(ring, chart.shades && std::isfinite(d.value) ? chart.shades->of(d.value) : grain);
    canvas.stroke(ring, {outline, 0.5});
  }
}

void draw_lines(Canvas& canvas, const Frame& frame, std::vector<SliceChart::Line> lines) {
  std::ranges::sort(lines, {}, [](const SliceChart::Line& l) { return std::pair{l.marked, l.width}; });
  double most = 0;
  for (const auto& l : lines) most = std::max(most, l.width);
  for (const auto& l : lines)
    canvas.stroke(std::array{frame(l.x0, l.y0), frame(l.x1, l.y1)},
                  {l.marked ? marked : plain, std::max(0.15, widest_line * l.width / most)});
}

void draw_arrow(Canvas& canvas, const Point& from, const Point& to) {
  canvas.stroke(std::array{from, to}, {plain, 0.9});
  const double dx = to.x - from.x, dy = to.y - from.y, length = std::hypot(dx, dy), head = std::min(4.0, 0.4 * length);
  if (!(length > 0)) return;
  const double ux = head * dx / length, uy = head * dy / length;
  canvas.polygon(std::array{to, Point{to.x - ux - 0.4 * uy, to.y - uy + 0.4 * ux},
                            Point{to.x - ux + 0.4 * uy, to.y - uy - 0.4 * ux}},
                 plain);
}

std::string with_exponent(const std::string& title, int exponent) {
  return exponent == 0 ? title : fmt::format("{} × {}", title, power_of_ten(exponent));
}

void draw_axes(Canvas& canvas, const Frame& frame, const SliceChart& chart) {
  canvas.stroke(std::array{Point{left, top}, Point{frame.right, top}, Point{frame.right, frame.bottom},
                           Point{left, frame.bottom}, Point{left, top}},
                {ink, 0.8});
  const auto count = [](double length) { return std::max(2, static_cast<int>(length / 70)); };
  const auto across = linear_ticks(chart.x_low, chart.x_high, count(frame.right - left));
  for (const auto& tick : across.ticks) {
    const double x = frame(tick.value, 0).x;
    canvas.stroke(std::array{Point{x, frame.bottom}, Point{x, frame.bottom + 4}}, {ink, 0.8});
    canvas.text({x, frame.bottom + 13}, tick.label, {.size = 9.5, .colour = ink, .align = Align::centre});
  }
  const auto upward = linear_ticks(chart.y_low, chart.y_high, count(frame.bottom - top));
  for (const auto& tick : upward.ticks) {
    const double y = frame(0, tick.value).y;
    canvas.stroke(std::array{Point{left - 4, y}, Point{left, y}}, {ink, 0.8});
    canvas.text({left - 8, y}, tick.label, {.size = 9.5, .colour = ink, .align = Align::right});
  }
  canvas.text({(left + frame.right) / 2, frame.bottom + 30}, with_exponent(chart.x, across.exponent),
              {.size = 10.5, .colour = ink, .align = Align::centre});
  canvas.text({18, (top + frame.bottom) / 2}, with_exponent(chart.y, upward.exponent),
              {.size = 10.5, .colour = ink, .align = Align::centre, .angle = -std::numbers::pi / 2});
}

void draw_shades(Canvas& canvas, const Frame& frame, const Shades& shades) {
  constexpr int steps = 60;
  const double x = frame.right + 16, height = frame.bottom - top;
  for (int k = 0; k < steps; ++k)
    canvas.rectangle({x, frame.bottom - height * k / steps}, {x + 12, frame.bottom - height * (k + 1) / steps - 0.3},
                     shades.of(shades.low + (shades.high - shades.low) * (k + 0.5) / steps));
  canvas.text({x + 17, frame.bottom}, fmt::format("{:.3g}", shades.low), {.size = 9.5, .colour = ink});
  canvas.text({x + 17, top}, fmt::format("{:.3g}", shades.high), {.size = 9.5, .colour = ink});
  canvas.text({x + 24, (top + frame.bottom) / 2}, shades.title,
              {.size = 10.5, .colour = ink, .align = Align::centre, .angle = -std::numbers::pi / 2});
}

}  // namespace

void write_slice(const SliceChart& chart, const std::filesystem::path& path) {
  const Frame frame(chart);
  Canvas canvas(path, std::max(360.0, frame.right + (chart.shades ? 62 : 24)), frame.bottom + beneath);
  canvas.headings(16, chart.title, chart.subtitle);
  canvas.clip({left, top}, {frame.right, frame.bottom});
  draw_disks(canvas, frame, chart);
  draw_lines(canvas, frame, chart.lines);
  for (const auto& a : chart.arrows) draw_arrow(canvas, frame(a.x, a.y), frame(a.x + a.dx, a.y + a.dy));
  canvas.unclip();
  draw_axes(canvas, frame, chart);
  if (chart.shades) draw_shades(canvas, frame, *chart.shades);
  canvas.text({16, frame.bottom + 50}, chart.note, {.size = 9.5, .colour = faint});
  canvas.save();
}

}  // namespace eg
