#pragma once
// A slice through a packing, to scale: grains as disks, forces as lines, displacements as arrows.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "report/plot.hpp"

namespace eg {

struct SliceChart {
  struct Disk {
    double x = 0, y = 0, radius = 0;
    double value = automatic;  ///< of `shades`; not finite: left white
  };
  struct Line {
    double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    double width = 1;  ///< over the widest
    bool marked = false;
  };
  struct Arrow {
    double x = 0, y = 0, dx = 0, dy = 0;
  };
  std::string title{}, subtitle{};
  std::string x{}, y{};                                 ///< titles of the axes, with unit
  double x_low = 0, x_high = 1, y_low = 0, y_high = 1;  ///< what is shown; nothing appears beyond
  std::vector<Disk> disks{};
  std::vector<Line> lines{};  ///< drawn from thin to thick, marked ones last and in another colour
  std::vector<Arrow> arrows{};
  std::string note{};  ///< below the axes: what widths, colours and lengths mean
  std::optional<Shades> shades{};
};

/// One unit of x is as long as one of y. The ending of `path` (.svg, .png, .pdf) is the format. Throws InputError when
/// that is unknown or the file cannot be written.
void write_slice(const SliceChart& chart, const std::filesystem::path& path);

}  // namespace eg
