#pragma once
// A page to draw on: the few strokes that figures need, the same for every file format. Lengths in points (1/72 inch),
// y downwards. Thin over cairo, which stays inside canvas.cpp.
#include <filesystem>
#include <memory>
#include <span>
#include <string>

struct _cairo;
struct _cairo_surface;

namespace eg {

struct Point {
  double x = 0, y = 0;
};

struct Colour {
  double red = 0, green = 0, blue = 0, alpha = 1;  ///< each 0 … 1
};

enum class Dash { solid, dashed, dotted, dash_dot };
enum class Marker { none, circle, square, triangle, diamond, cross, open_circle };
enum class Fill { solid, hatched };  ///< hatched: diagonal lines over a light tint
enum class Align { left, centre, right };

struct Pen {
  Colour colour{};
  double width = 1;
  Dash dash = Dash::solid;
};

struct TextStyle {
  double size = 10;
  bool bold = false;
  Colour colour{};
  Align align = Align::left;
  double angle = 0;  ///< [rad], clockwise
};

class Canvas {
 public:
  /// The ending of `path` (.svg, .png, .pdf) is the format; PNG has two pixels a point. Folders are made as needed.
  /// Throws InputError for another ending.
  Canvas(std::filesystem::path path, double width, double height);
  /// Writes the file. Throws InputError when that fails. Nothing may be drawn afterwards.
  void save();

  void stroke(std::span<const Point> points, const Pen& pen);
  /// Fills the closed polygon and draws its edge in the same colour, so that neighbours leave no gap.
  void polygon(std::span<const Point> corners, const Colour& colour);
  void rectangle(Point a, Point b, const Colour& colour, Fill fill = Fill::solid);
  /// `columns` × `rows` equal cells between two corners, row after row from the corner a (alpha is not read); PNG, SVG
  /// and PDF all hold it as pixels.
  void image(Point a, Point b, std::size_t columns, std::size_t rows, std::span<const Colour> colours);
  void marker(Point at, Marker marker, double size, const Colour& colour);
  /// Text with the middle of its height of capitals at `at`.
  void text(Point at, const std::string& text, const TextStyle& style);
  double text_width(const std::string& text, const TextStyle& style) const;
  /// Title and subtitle at the top of the page, smaller where it is too narrow for them.
  void headings(double left, const std::string& title, const std::string& subtitle);
  /// Until unclip(), nothing appears outside the rectangle.
  void clip(Point a, Point b);
  void unclip();

 private:
  struct Release {
    void operator()(_cairo* context) const;
    void operator()(_cairo_surface* surface) const;
  };
  void set(const Pen& pen);
  void set(const TextStyle& style) const;

  std::filesystem::path path_;
  double width_;
  std::unique_ptr<_cairo_surface, Release> surface_;
  std::unique_ptr<_cairo, Release> context_;
};

}  // namespace eg
