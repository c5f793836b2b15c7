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
#include <string>
#include <vector>

#include "report/canvas.hpp"

namespace eg {

inline constexpr double automatic = std::numeric_limits<double>::quiet_NaN();  ///< let the figure choose

struct Axis {
  std::string title{};                       ///< with the unit in square brackets
  bool logarithmic = false;                  ///< values ≤ 0 are then left out
  double low = automatic, high = automatic;  ///< shown range
  std::vector<std::string> rows{};           ///< names of the places 0, 1, 2 … instead of numbers (y: 0 on top)
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

struct Figure {
  std::string title{}, subtitle{};
  Axis x{}, y{};
  std::vector<Reference> references{};
  std::vector<Bar> bars{};
  std::vector<Series> series{};
  std::vector<LegendKey> keys{};     ///< of bars; drawn below the axes
  double width = 560, height = 380;  ///< [pt]
};

/// Draws the figure into a file; its ending (.svg, .png, .pdf) is the format. Throws InputError when the ending is
/// unknown, the file cannot be written, or a series has x and y of different lengths.
void write_figure(const Figure& figure, const std::filesystem::path& path);

}  // namespace eg
