#include "app/measure_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/packing_input.hpp"
#include "report/rose_chart.hpp"

namespace eg {
namespace {

void draw_rose(const MeasureReport& r, bool force, const std::string& path) {
  RoseChart chart;
  chart.title = r.title.empty() ? r.name : r.title;
  chart.subtitle = force ? "mean normal force by direction of the contact" : "contacts by direction";
  chart.value = force ? "mean normal force over that of all contacts [-]" : "contacts over those of an even spread [-]";
  chart.solid = r.dimension == 3;
  for (const auto& p : r.rose)
    chart.petals.push_back({p.azimuth_from, p.azimuth_to, p.height_from, p.height_to, force ? p.force : p.density});
  write_rose(chart, path);
  fmt::print(stderr, "figure: {}\n", path);
}

Series bins_of(const Histogram& h, const std::string& label) {
  Series s{.label = label, .points = true};
  for (std::size_t k = 0; k < h.count.size(); ++k)
    if (h.count[k] > 0) s.x.push_back(h.middle(k)), s.y.push_back(h.density(k));
  return s;
}

Figure connectivity_figure(const MeasureReport& r) {
  Figure f;
  f.x = {.title = "contacts of a particle [-]"}, f.y = {.title = "share of particles [-]", .low = 0};
  double all = 0;
  for (const auto n : r.connectivity) all += static_cast<double>(n);
  Series s{.points = true};
  for (std::size_t k = 0; k < r.connectivity.size(); ++k)
    s.x.push_back(static_cast<double>(k)), s.y.push_back(static_cast<double>(r.connectivity[k]) / all);
  f.series.push_back(s);
  return f;
}

Figure force_figure(const MeasureReport& r) {
  Figure f;
  f.x = {.title = "normal force over mean normal force [-]"};
  f.y = {.title = "probability density [-]", .logarithmic = true};
  f.series.push_back(bins_of(r.forces, "contacts"));
  return f;
}

Figure spin_figure(const MeasureReport& r) {
  Figure f;
  f.x = {.title = "angular velocity over its standard deviation [-]"};
  f.y = {.title = "probability density [-]", .logarithmic = true};
  f.series.push_back(bins_of(r.spins.scaled, "particles"));
  Series normal{.label = "normal distribution"};
  for (double x = -3.5; x <= 3.5; x += 0.1)
    normal.x.push_back(x), normal.y.push_back(std::exp(-x * x / 2) / std::sqrt(2 * std::numbers::pi));
  f.series.push_back(normal);
  return f;
}

Figure fraction_figure(const MeasureReport& r) {
  Figure f;
  f.x = {.title = "share of the whole [-]", .low = 0};
  constexpr Colour solids{0.62, 0.66, 0.7}, stress{0.00, 0.36, 0.64};
  double longest = 0;
  for (const auto& part : r.fractions) longest = std::max({longest, part.solid_share, part.mean_stress_share});
  f.x.high = 1.25 * longest;  // room for the texts
  for (std::size_t k = 0; const auto& part : r.fractions) {
    f.y.rows.push_back(std::isfinite(part.largest)
                           ? fmt::format("{:.3g} … {:.3g} mm", 1e3 * part.smallest, 1e3 * part.largest)
                           : fmt::format("above {:.3g} mm", 1e3 * part.smallest));
    const auto row = static_cast<double>(k++);
    f.bars.push_back({row - 0.14, 0, part.solid_share, solids});
    f.bars.push_back({.row = row + 0.14,
                      .to = part.mean_stress_share,
                      .colour = stress,
                      .text = fmt::format("{:.2f} of the mean", part.stress_ratio)});
  }
  f.keys = {{"volume of grains", solids}, {"mean stress", stress}};
  return f;
}

}  // namespace

const std::vector<std::string>& measure_figures() {
  static const std::vector<std::string> names{"rose", "force-rose", "connectivity", "forces", "spins", "fractions"};
  return names;
}

void draw_measure(const MeasureReport& r, const std::string& kind, const std::string& path) {
  if (kind == "rose" || kind == "force-rose") return draw_rose(r, kind == "force-rose", path);
  Figure f = kind == "connectivity" ? connectivity_figure(r)
             : kind == "forces"     ? force_figure(r)
             : kind == "spins"      ? spin_figure(r)
                                    : fraction_figure(r);
  f.title = r.title.empty() ? r.name : r.title;
  save_figure(f, path);
}

}  // namespace eg
