#include "report/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "report/scale.hpp"

namespace eg {

namespace {

constexpr Colour ink{0.13, 0.13, 0.15}, grid{0.88, 0.88, 0.9};
constexpr TextStyle small{.size = 9.5, .colour = ink};

/// How the k-th series looks. Colours after Okabe and Ito 2008, apart for every kind of colour vision.
struct Look {
  Colour colour;
  Dash dash;
  Marker marker;
};
Look look(std::size_t k) {
  static constexpr std::array<Look, 6> looks{{{{0.00, 0.36, 0.64}, Dash::solid, Marker::circle},
                                              {{0.80, 0.33, 0.00}, Dash::dashed, Marker::square},
                                              {{0.00, 0.52, 0.40}, Dash::dash_dot, Marker::triangle},
                                              {{0.10, 0.10, 0.12}, Dash::dotted, Marker::diamond},
                                              {{0.66, 0.36, 0.55}, Dash::solid, Marker::cross},
                                              {{0.75, 0.52, 0.00}, Dash::dashed, Marker::open_circle}}};
  return looks[k % looks.size()];
}

/// All values that an axis has to show.
std::vector<double> values_on(const Figure& figure, Reference::Across axis) {
  const bool horizontal = axis == Reference::Across::x;
  std::vector<double> values;
  for (const auto& s : figure.series) {
    const auto& own = horizontal ? s.x : s.y;
    values.insert(values.end(), own.begin(), own.end());
  }
  const auto& own = horizontal ? figure.shaded.x : figure.shaded.y;
  values.insert(values.end(), own.begin(), own.end());
  if (figure.map.columns > 0)
    values.insert(values.end(), {horizontal ? figure.map.x_low : figure.map.y_low,
                                 horizontal ? figure.map.x_high : figure.map.y_high});
  for (const auto& bar : figure.bars)
    if (horizontal)
      values.insert(values.end(), {bar.from, bar.to});
    else
      values.push_back(bar.row);
  for (const auto& reference : figure.references)
    if (reference.axis == axis && std::isnan(reference.to)) values.push_back(reference.from);
  return values;
}

/// Draws one figure on one canvas, back to front.
class Painter {
 public:
  Painter(const Figure& figure, Canvas& canvas) : figure_(figure), canvas_(canvas) {
    x_ = scale_for(figure.x, values_on(figure, Reference::Across::x));
    y_ = scale_for(figure.y, values_on(figure, Reference::Across::y));
    x_ticks_ = ticks_for(figure.x, x_), y_ticks_ = ticks_for(figure.y, y_);
    place();
  }

  void paint() {
    canvas_.clip({x_.start, y_.end}, {x_.end, y_.start});
    map();
    bands();
    grid_lines();
    canvas_.unclip();
    reference_lines();
    bars();
    canvas_.clip({x_.start - 4, top_ - 4}, {x_.end + 4, bottom_ + 4});
    shaded_points();
    for (std::size_t k = 0; k < figure_.series.size(); ++k) curve(figure_.series[k], look(k));
    canvas_.unclip();
    frame();
    titles();
    legend();
    keys();
    shade_bar();
  }

 private:
  /// Leaves room for titles and labels; the rest is for the axes.
  void place() {
    double labels = 0;
    for (const auto& tick : y_ticks_.ticks) labels = std::max(labels, canvas_.text_width(tick.label, small));
    const double left = 16 + labels + 8 + (figure_.y.title.empty() ? 0 : 20);
    top_ = 16 + (figure_.title.empty() ? 0 : 20) + (figure_.subtitle.empty() ? 0 : 16);
    const bool label_above = std::ranges::any_of(
        figure_.references, [](const Reference& r) { return r.axis == Reference::Across::x && !r.label.empty(); });
    if (label_above) top_ += 14;
    bottom_ = figure_.height - 30 - (figure_.x.title.empty() ? 0 : 18) - (figure_.keys.empty() ? 0 : 22);
    x_.start = left, x_.end = figure_.width - (figure_.shades ? 92 : 24);
    y_.start = figure_.y.rows.empty() ? bottom_ : top_, y_.end = figure_.y.rows.empty() ? top_ : bottom_;
  }

  void bands() {
    for (const auto& band : figure_.references) {
      if (std::isnan(band.to)) continue;
      const bool across_x = band.axis == Reference::Across::x;
      const Scale& scale = across_x ? x_ : y_;
      const double a = scale(std::max(band.from, scale.low)), b = scale(std::min(band.to, scale.high));
      if (!(std::abs(b - a) > 0) || band.from > scale.high || band.to < scale.low) continue;
      if (across_x)
        canvas_.rectangle({a, top_}, {b, bottom_}, band.colour, band.fill);
      else
        canvas_.rectangle({x_.start, a}, {x_.end, b}, band.colour, band.fill);
    }
  }

  void map() {
    const auto& m = figure_.map;
    if (m.columns == 0 || !figure_.shades) return;
    std::vector<Colour> colours;
    for (const double v : m.value) colours.push_back(figure_.shades->of(v));
    canvas_.image({x_(m.x_low), y_(m.y_low)}, {x_(m.x_high), y_(m.y_high)}, m.columns, m.rows, colours);
  }

  void shaded_points() {
    const auto& s = figure_.shaded;
    for (std::size_t k = 0; k < s.x.size() && figure_.shades; ++k)
      if (x_.shows(s.x[k]) && y_.shows(s.y[k]))
        canvas_.marker({x_(s.x[k]), y_(s.y[k])}, Marker::circle, s.size, figure_.shades->of(s.value[k]));
  }

  /// The scale of a third quantity, right of the axes.
  void shade_bar() {
    if (!figure_.shades) return;
    const Shades& shades = *figure_.shades;
    constexpr std::size_t steps = 128;
    std::vector<Colour> colours;
    for (std::size_t k = 0; k < steps; ++k)
      colours.push_back(shades.of(shades.low + (shades.high - shades.low) * (static_cast<double>(k) + 0.5) / steps));
    const double left = x_.end + 16, right = left + 12;
    canvas_.image({left, bottom_}, {right, top_}, 1, steps, colours);
    const std::array corners{Point{left, top_}, Point{right, top_}, Point{right, bottom_}, Point{left, bottom_},
                             Point{left, top_}};
    canvas_.stroke(corners, {ink, 0.7});
    const Scale scale{.low = shades.low, .high = shades.high, .start = bottom_, .end = top_};
    const Ticks ticks = linear_ticks(shades.low, shades.high, 5);
    for (const auto& tick : ticks.ticks) canvas_.text({right + 5, scale(tick.value)}, tick.label, small);
    TextStyle turned{.size = 10.5, .colour = ink, .align = Align::centre};
    turned.angle = -std::numbers::pi / 2;
    canvas_.text({figure_.width - 14, (top_ + bottom_) / 2}, with_exponent(shades.title, ticks.exponent), turned);
  }

  void grid_lines() {
    for (const auto& tick : x_ticks_.ticks)
      if (!tick.label.empty()) segment({x_(tick.value), top_}, {x_(tick.value), bottom_}, {grid, 0.7});
    for (const auto& tick : y_ticks_.ticks)
      if (!tick.label.empty()) segment({x_.start, y_(tick.value)}, {x_.end, y_(tick.value)}, {grid, 0.7});
  }

  void reference_lines() {
    for (const auto& line : figure_.references) {
      const bool across_x = line.axis == Reference::Across::x, band = !std::isnan(line.to);
      const Scale& scale = across_x ? x_ : y_;
      const double low = std::max(line.from, scale.low), high = std::min(band ? line.to : line.from, scale.high);
      if (low > high) continue;
      if (!band && across_x) segment({scale(low), top_}, {scale(low), bottom_}, {line.colour, 1.2, line.dash});
      if (!band && !across_x) segment({x_.start, scale(low)}, {x_.end, scale(low)}, {line.colour, 1.2, line.dash});
      name_reference(line, (scale(low) + scale(high)) / 2);
    }
  }

  /// Above the axes over its place on x, or inside at the right end over its place on y.
  void name_reference(const Reference& line, double place) {
    TextStyle style{.size = 9, .bold = true, .colour = line.colour, .align = Align::centre};
    style.colour.alpha = 1;
    const double half = canvas_.text_width(line.label, style) / 2;
    if (line.axis == Reference::Across::x)
      canvas_.text({std::clamp(place, x_.start + half, x_.end - half), top_ - 8}, line.label, style);
    else
      canvas_.text({x_.end - half - 4, place - 7}, line.label, style);
  }

  void bars() {
    constexpr TextStyle style{.size = 9, .colour = ink};
    const double half = std::min(0.2 * std::abs(y_(1) - y_(0)), 3.5);
    for (const auto& bar : figure_.bars) {
      const double y = y_(bar.row);
      const double from = x_(std::clamp(bar.from, x_.low, x_.high)), to = x_(std::clamp(bar.to, x_.low, x_.high));
      canvas_.rectangle({from, y - half}, {to, y + half}, bar.colour, bar.fill);
      canvas_.marker({to, y}, bar.marker, 9, bar.colour);
      if (bar.text.empty()) continue;
      const double gap = bar.marker == Marker::none ? 4 : 8, width = canvas_.text_width(bar.text, style);
      const bool leftward = to < from ? to - gap - width > x_.start : to + gap + width > x_.end;
      const double x = leftward ? to - gap - width : to + gap;
      canvas_.rectangle({x - 1.5, y - 6}, {x + width + 1.5, y + 6}, {1, 1, 1, 0.82});
      canvas_.text({x, y}, bar.text, style);
    }
  }

  void curve(const Series& series, const Look& look) {
    std::vector<Point> run;
    const auto flush = [&] {
      if (series.line && figure_.map.columns > 0) canvas_.stroke(run, {{1, 1, 1, 0.8}, 3.6});  // apart from the map
      if (series.line) canvas_.stroke(run, {look.colour, 1.8, look.dash});
      run.clear();
    };
    for (std::size_t k = 0; k < series.x.size(); ++k) {
      const Point p{x_(series.x[k]), y_(series.y[k])};
      if (std::isfinite(p.x) && std::isfinite(p.y))
        run.push_back(p);
      else
        flush();
    }
    flush();
    if (!series.points) return;
    for (std::size_t k = 0; k < series.x.size(); ++k) {
      const Point p{x_(series.x[k]), y_(series.y[k])};
      if (x_.shows(series.x[k]) && y_.shows(series.y[k])) canvas_.marker(p, look.marker, 6, look.colour);
    }
  }

  void frame() {
    const Pen pen{ink, 0.9};
    const std::array corners{Point{x_.start, top_}, Point{x_.end, top_}, Point{x_.end, bottom_},
                             Point{x_.start, bottom_}, Point{x_.start, top_}};
    canvas_.stroke(corners, pen);
    TextStyle style = small;
    for (const auto& tick : x_ticks_.ticks) {
      const double x = x_(tick.value);
      segment({x, bottom_}, {x, bottom_ - (tick.label.empty() ? 2.5 : 4.5)}, pen);
      style.align = Align::centre;
      canvas_.text({x, bottom_ + 11}, tick.label, style);
    }
    for (const auto& tick : y_ticks_.ticks) {
      const double y = y_(tick.value);
      if (figure_.y.rows.empty()) segment({x_.start, y}, {x_.start + (tick.label.empty() ? 2.5 : 4.5), y}, pen);
      style.align = Align::right;
      canvas_.text({x_.start - 6, y}, tick.label, style);
    }
  }

  void titles() {
    const double left = figure_.y.rows.empty() ? x_.start : 16;
    canvas_.headings(left, figure_.title, figure_.subtitle);
    const TextStyle style{.size = 10.5, .colour = ink, .align = Align::centre};
    canvas_.text({(x_.start + x_.end) / 2, bottom_ + 30}, with_exponent(figure_.x.title, x_ticks_.exponent), style);
    TextStyle turned = style;
    turned.angle = -std::numbers::pi / 2;
    canvas_.text({16, (top_ + bottom_) / 2}, with_exponent(figure_.y.title, y_ticks_.exponent), turned);
  }

  static std::string with_exponent(const std::string& title, int exponent) {
    return exponent == 0 ? title : fmt::format("{}{}× {}", title, title.empty() ? "" : "   ", power_of_ten(exponent));
  }

  /// In the corner of the axes that hides the fewest points.
  void legend() {
    std::vector<std::size_t> named;
    double width = 0;
    for (std::size_t k = 0; k < figure_.series.size(); ++k)
      if (!figure_.series[k].label.empty()) {
        named.push_back(k);
        width = std::max(width, canvas_.text_width(figure_.series[k].label, small));
      }
    if (named.empty()) return;
    width += 46;
    const double height = 14.0 * static_cast<double>(named.size()) + 8;
    const Point at = emptiest_corner(width, height);
    canvas_.rectangle(at, {at.x + width, at.y + height}, {1, 1, 1, 0.85});
    double y = at.y + 11;
    for (const auto k : named) {
      const Look mine = look(k);
      if (figure_.series[k].line) segment({at.x + 6, y}, {at.x + 34, y}, {mine.colour, 1.8, mine.dash});
      if (figure_.series[k].points) canvas_.marker({at.x + 20, y}, mine.marker, 6, mine.colour);
      canvas_.text({at.x + 40, y}, figure_.series[k].label, small);
      y += 14;
    }
  }

  Point emptiest_corner(double width, double height) const {
    constexpr double room = 8;
    const std::array corners{Point{x_.end - width - room, top_ + room}, Point{x_.start + room, top_ + room},
                             Point{x_.end - width - room, bottom_ - height - room},
                             Point{x_.start + room, bottom_ - height - room}};
    const auto hidden = [&](const Point& at) {
      double share = 0;  // of each curve's points, so that a dense curve does not outvote a sparse one
      for (const auto& s : figure_.series) {
        int count = 0;
        for (std::size_t k = 0; k < s.x.size(); ++k) {
          const double x = x_(s.x[k]), y = y_(s.y[k]);
          count += x > at.x - 4 && x < at.x + width + 4 && y > at.y - 4 && y < at.y + height + 4;
        }
        share += s.x.empty() ? 0 : count / static_cast<double>(s.x.size());
      }
      return share;
    };
    return *std::ranges::min_element(corners, {}, hidden);
  }

  void keys() {
    const double y = figure_.height - 16;
    double x = x_.start;
    for (const auto& key : figure_.keys) {
      canvas_.rectangle({x, y - 3.5}, {x + 22, y + 3.5}, key.colour, key.fill);
      canvas_.marker({x + 22, y}, key.marker, 9, key.colour);
      canvas_.text({x + 32, y}, key.label, small);
      x += 32 + canvas_.text_width(key.label, small) + 20;
    }
  }

  void segment(Point a, Point b, const Pen& pen) { canvas_.stroke(std::array{a, b}, pen); }

  const Figure& figure_;
  Canvas& canvas_;
  Scale x_, y_;
  Ticks x_ticks_, y_ticks_;
  double top_ = 0, bottom_ = 0;  ///< of the axes [pt]
};

}  // namespace

Colour Shades::of(double value) const {
  static const std::vector<Colour> grey{{1, 1, 1}, {0.55, 0.60, 0.68}, {0.08, 0.10, 0.18}};
  const auto& anchors = colours.empty() ? grey : colours;
  const double share = std::isfinite(value) ? std::clamp((value - low) / (high - low), 0.0, 1.0) : 0;
  const double place = share * static_cast<double>(anchors.size() - 1);
  const auto k = std::min(static_cast<std::size_t>(place), anchors.size() - std::min<std::size_t>(2, anchors.size()));
  const Colour& a = anchors[k];
  const Colour& b = anchors[std::min(k + 1, anchors.size() - 1)];
  const double t = place - static_cast<double>(k);
  return {a.red + t * (b.red - a.red), a.green + t * (b.green - a.green), a.blue + t * (b.blue - a.blue)};
}

void write_figure(const Figure& figure, const std::filesystem::path& path) {
  for (const auto& s : figure.series)
    if (s.x.size() != s.y.size())
      throw input_error(path.string(), 0, fmt::format("series \"{}\"", s.label),
                        fmt::format("has {} x and {} y", s.x.size(), s.y.size()), "give as many of each");
  Canvas canvas(path, figure.width, figure.height);
  Painter(figure, canvas).paint();
  canvas.save();
}

}  // namespace eg
