#include "report/canvas.hpp"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <cairo.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numbers>
#include <utility>

#include "base/error.hpp"

namespace eg {

namespace {

constexpr double pixels_a_point = 2;

void set_colour(cairo_t* c, const Colour& colour) {
  cairo_set_source_rgba(c, colour.red, colour.green, colour.blue, colour.alpha);
}

cairo_surface_t* open_surface(const std::filesystem::path& path, double width, double height) {
  const auto ending = path.extension();
  if (ending == ".svg") return cairo_svg_surface_create(path.c_str(), width, height);
  if (ending == ".pdf") return cairo_pdf_surface_create(path.c_str(), width, height);
  if (ending == ".png")
    return cairo_image_surface_create(CAIRO_FORMAT_ARGB32, static_cast<int>(std::ceil(width * pixels_a_point)),
                                      static_cast<int>(std::ceil(height * pixels_a_point)));
  throw input_error(path.string(), 0, "the ending", "names no figure format", "use .svg, .png or .pdf");
}

}  // namespace

void Canvas::Release::operator()(_cairo* context) const { cairo_destroy(context); }
void Canvas::Release::operator()(_cairo_surface* surface) const { cairo_surface_destroy(surface); }

Canvas::Canvas(std::filesystem::path path, double width, double height) : path_(std::move(path)), width_(width) {
  std::error_code ignored;  // a folder that cannot be made shows when the file is written
  if (path_.has_parent_path()) std::filesystem::create_directories(path_.parent_path(), ignored);
  surface_.reset(open_surface(path_, width, height));
  context_.reset(cairo_create(surface_.get()));
  cairo_t* c = context_.get();
  if (path_.extension() == ".png") cairo_scale(c, pixels_a_point, pixels_a_point);
  // Metrics free of hinting: text takes the same room in every format.
  cairo_font_options_t* options = cairo_font_options_create();
  cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
  cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
  cairo_set_font_options(c, options);
  cairo_font_options_destroy(options);
  cairo_set_source_rgb(c, 1, 1, 1);
  cairo_paint(c);
}

void Canvas::save() {
  cairo_status_t status = cairo_status(context_.get());
  cairo_surface_flush(surface_.get());
  if (status == CAIRO_STATUS_SUCCESS && path_.extension() == ".png")
    status = cairo_surface_write_to_png(surface_.get(), path_.c_str());
  cairo_surface_finish(surface_.get());
  if (status == CAIRO_STATUS_SUCCESS) status = cairo_surface_status(surface_.get());
  if (status != CAIRO_STATUS_SUCCESS)
    throw input_error(path_.string(), 0, "cannot be written:", cairo_status_to_string(status), "choose another place");
}

void Canvas::set(const Pen& pen) {
  cairo_t* c = context_.get();
  set_colour(c, pen.colour);
  cairo_set_line_width(c, pen.width);
  cairo_set_line_join(c, CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_cap(c, pen.dash == Dash::solid ? CAIRO_LINE_CAP_ROUND : CAIRO_LINE_CAP_BUTT);
  const double unit = std::max(pen.width, 0.8);
  const double dashed[] = {5 * unit, 3 * unit}, dotted[] = {1.2 * unit, 2 * unit};
  const double dash_dot[] = {6 * unit, 2 * unit, 1.2 * unit, 2 * unit};
  switch (pen.dash) {
    case Dash::solid:
      cairo_set_dash(c, nullptr, 0, 0);
      break;
    case Dash::dashed:
      cairo_set_dash(c, dashed, 2, 0);
      break;
    case Dash::dotted:
      cairo_set_dash(c, dotted, 2, 0);
      break;
    case Dash::dash_dot:
      cairo_set_dash(c, dash_dot, 4, 0);
      break;
  }
}

void Canvas::stroke(std::span<const Point> points, const Pen& pen) {
  if (points.size() < 2) return;
  set(pen);
  cairo_new_path(context_.get());
  for (const auto& p : points) cairo_line_to(context_.get(), p.x, p.y);
  cairo_stroke(context_.get());
}

void Canvas::polygon(std::span<const Point> corners, const Colour& colour) {
  set({colour, 0.4, Dash::solid});
  cairo_t* c = context_.get();
  cairo_new_path(c);
  for (const auto& p : corners) cairo_line_to(c, p.x, p.y);
  cairo_close_path(c);
  cairo_fill_preserve(c);
  cairo_stroke(c);
}

void Canvas::rectangle(Point a, Point b, const Colour& colour, Fill fill) {
  cairo_t* c = context_.get();
  const double left = std::min(a.x, b.x), right = std::max(a.x, b.x), top = std::min(a.y, b.y),
               bottom = std::max(a.y, b.y);
  cairo_rectangle(c, left, top, right - left, bottom - top);
  if (fill == Fill::solid) {
    set_colour(c, colour);
    cairo_fill(c);
    return;
  }
  cairo_save(c);
  cairo_clip_preserve(c);
  set_colour(c, {colour.red, colour.green, colour.blue, 0.18 * colour.alpha});
  cairo_fill(c);
  set({colour, 0.9, Dash::solid});
  constexpr double spacing = 4;  // lines on a grid fixed to the page, so that neighbouring areas match
  const double height = bottom - top;
  for (double x = spacing * std::floor((left + top - bottom) / spacing); x < right; x += spacing) {
    const double shift = std::fmod(bottom, spacing);
    cairo_move_to(c, x + shift, bottom);
    cairo_line_to(c, x + shift + height, top);
  }
  cairo_stroke(c);
  cairo_restore(c);
}

void Canvas::image(Point a, Point b, std::size_t columns, std::size_t rows, std::span<const Colour> colours) {
  cairo_t* c = context_.get();
  const int width = static_cast<int>(columns), height = static_cast<int>(rows);
  cairo_surface_t* pixels = cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height);
  unsigned char* data = cairo_image_surface_get_data(pixels);
  const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(pixels));
  const auto level = [](double x) { return static_cast<std::uint32_t>(std::lround(255 * std::clamp(x, 0.0, 1.0))); };
  for (std::size_t row = 0; row < rows && data; ++row)
    for (std::size_t column = 0; column < columns; ++column) {
      const Colour& colour = colours[row * columns + column];
      const std::uint32_t pixel = level(colour.red) << 16 | level(colour.green) << 8 | level(colour.blue);
      std::memcpy(data + row * stride + 4 * column, &pixel, sizeof pixel);
    }
  cairo_surface_mark_dirty(pixels);
  cairo_save(c);
  cairo_translate(c, a.x, a.y);
  cairo_scale(c, (b.x - a.x) / width, (b.y - a.y) / height);
  cairo_set_source_surface(c, pixels, 0, 0);
  cairo_pattern_set_filter(cairo_get_source(c), CAIRO_FILTER_NEAREST);
  cairo_paint(c);
  cairo_restore(c);
  cairo_surface_destroy(pixels);
}

void Canvas::marker(Point at, Marker marker, double size, const Colour& colour) {
  cairo_t* c = context_.get();
  const double r = size / 2;
  set({colour, std::max(1.0, size / 5), Dash::solid});
  cairo_new_path(c);
  const auto polygon = [&](std::initializer_list<Point> corners) {
    for (const auto& p : corners) cairo_line_to(c, at.x + r * p.x, at.y + r * p.y);
    cairo_close_path(c);
    cairo_fill(c);
  };
  switch (marker) {
    case Marker::none:
      break;
    case Marker::circle:
      cairo_arc(c, at.x, at.y, r, 0, 2 * std::numbers::pi);
      cairo_fill(c);
      break;
    case Marker::open_circle:
      cairo_arc(c, at.x, at.y, r, 0, 2 * std::numbers::pi);
      cairo_stroke(c);
      break;
    case Marker::square:
      polygon({{-.9, -.9}, {.9, -.9}, {.9, .9}, {-.9, .9}});
      break;
    case Marker::triangle:
      polygon({{0, -1.15}, {1.05, .75}, {-1.05, .75}});
      break;
    case Marker::diamond:
      polygon({{0, -1.25}, {1.25, 0}, {0, 1.25}, {-1.25, 0}});
      break;
    case Marker::cross:
      cairo_move_to(c, at.x - r, at.y - r), cairo_line_to(c, at.x + r, at.y + r);
      cairo_move_to(c, at.x - r, at.y + r), cairo_line_to(c, at.x + r, at.y - r);
      cairo_stroke(c);
      break;
  }
}

void Canvas::set(const TextStyle& style) const {
  cairo_select_font_face(context_.get(), "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                         style.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(context_.get(), style.size);
}

double Canvas::text_width(const std::string& text, const TextStyle& style) const {
  set(style);
  cairo_text_extents_t extents;
  cairo_text_extents(context_.get(), text.c_str(), &extents);
  return extents.x_advance;
}

void Canvas::text(Point at, const std::string& text, const TextStyle& style) {
  cairo_t* c = context_.get();
  const double share = style.align == Align::left ? 0 : style.align == Align::centre ? 0.5 : 1;
  const double shift = -share * text_width(text, style);
  constexpr double half_capital = 0.364;  // of the size, DejaVu Sans
  set_colour(c, style.colour);
  cairo_save(c);
  cairo_translate(c, at.x, at.y);
  cairo_rotate(c, style.angle);
  cairo_move_to(c, shift, half_capital * style.size);
  cairo_show_text(c, text.c_str());
  cairo_restore(c);
}

void Canvas::headings(double left, const std::string& title, const std::string& subtitle) {
  const auto fitted = [&](Point at, const std::string& text, TextStyle style) {
    style.size *= std::min(1.0, (width_ - at.x - 8) / std::max(1.0, text_width(text, style)));
    this->text(at, text, style);
  };
  fitted({left, 20}, title, {.size = 13, .bold = true, .colour = {0.13, 0.13, 0.15}});
  fitted({left, title.empty() ? 18.0 : 37.0}, subtitle, {.size = 9.5, .colour = {0.42, 0.42, 0.46}});
}

void Canvas::clip(Point a, Point b) {
  cairo_save(context_.get());
  cairo_rectangle(context_.get(), std::min(a.x, b.x), std::min(a.y, b.y), std::abs(b.x - a.x), std::abs(b.y - a.y));
  cairo_clip(context_.get());
}

void Canvas::unclip() { cairo_restore(context_.get()); }

}  // namespace eg
