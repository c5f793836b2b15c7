#pragma once
// Figures: fill in the data, write to a file. One road for the whole program and every format.
//
//   Figure figure;
//   figure.title = "Triaxial compression at 100 kPa";
//   figure.x = {.title = "axial strain [%]"};
//   figure.y = {.title = "deviator stress [kPa]"};
//   figure.series.push_back({.label = "dense", .x = strain, .y = stress});
//   write_figure(figure, "out/stress.svg");
//
// Series differ by dash and marker as well as by colour, so a figure survives a grey print.
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "report/canvas.hpp"

namespace eg {

inline constexpr double automatic = std::numeric_limits<double>::quiet_NaN();  ///< let the figure choose

struct Axis {
  std::string title{};                       ///< with the unit in square brackets
  bool logarithmic = false;                  ///< values ≤ 0 are then left out
  double low = automatic, high = automatic;  ///< shown range
  std::vector<std::string> rows{};           ///< names of the places 0, 1, 2 … instead of numbers (y: 0 on top)
  std::vector<std::pair<double, std::string>> marks{};  ///< named places in the place of numbered ticks, ascending
};

/// A curve, or points. Values that are not finite break the curve.
struct Series {
  std::string label{};  ///< in the legend; empty: not there
  std::vector<double> x{}, y{};
  bool line = true;
  bool points = false;
};

/// A horizontal bar at y = row, from x to x, with a mark at `to` and a text beyond it.
struct Bar {
  double row = 0, from = 0, to = 0;
  Colour colour{};
  Fill fill = Fill::solid;
  Marker marker = Marker::none;
  std::string text{};
};

/// A line across the axes at one value, or a shaded band between two.
struct Reference {
  enum class Across { x, y };  ///< the axis that the value is read on
  Across axis = Across::x;
  double from = 0, to = automatic;  ///< `to` not given: a line
  std::string label{};
  Colour colour{0.25, 0.25, 0.25};
  Dash dash = Dash::dashed;  ///< of a line
  Fill fill = Fill::solid;   ///< of a band
};

/// One entry of the legend that stands for a kind of bar.
struct LegendKey {
  std::string label{};
  Colour colour{};
  Fill fill = Fill::solid;
  Marker marker = Marker::none;
};

/// What a third quantity looks like: colours that darken or lighten steadily from low to high, so that grey keeps them
/// apart. Drawn as a bar beside the axes.
struct Shades {
  std::string title{};
  double low = 0, high = 1;       ///< values beyond take the colour of the end
  std::vector<Colour> colours{};  ///< at equal steps from low to high, blended in between; empty: white to near black

  Colour of(double value) const;
};

/// Points whose colour is a third value (Figure::shades). Not in the legend.
struct ShadedPoints {
  std::vector<double> x{}, y{}, value{};
  double size = 3.5;  ///< [pt]
};

/// A field over a rectangle, cell by cell (Figure::shades), below everything else.
struct HeatMap {
  double x_low = 0, x_high = 1, y_low = 0, y_high = 1;  ///< outer edges
  std::size_t columns = 0, rows = 0;
  std::vector<double> value{};  ///< row after row from y_low, columns from x_low
};

struct Figure {
  std::string title{}, subtitle{};
  Axis x{}, y{};
  std::vector<Reference> references{};
  std::vector<Bar> bars{};
  std::vector<Series> series{};
  HeatMap map{};  ///< drawn when it has cells; its axes are linear
  ShadedPoints shaded{};
  std::optional<Shades> shades{};    ///< needed by a map or shaded points
  std::vector<LegendKey> keys{};     ///< of bars; drawn below the axes
  double width = 560, height = 380;  ///< [pt]
};

/// Draws the figure into a file; its ending (.svg, .png, .pdf) is the format. Throws InputError when the ending is
/// unknown, the file cannot be written, or a series has x and y of different lengths.
void write_figure(const Figure& figure, const std::filesystem::path& path);

}  // namespace eg
