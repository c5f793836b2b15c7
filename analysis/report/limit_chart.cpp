#include "report/limit_chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace eg {

Figure limit_chart(std::vector<LimitRow> rows, double proved) {
  constexpr Colour stable{0.13, 0.38, 0.62}, unstable{0.78, 0.20, 0.05}, interval{0.10, 0.50, 0.35, 0.35};
  std::erase_if(rows, [](const LimitRow& row) { return !(std::isfinite(row.ratio) && row.ratio > 0); });
  std::ranges::stable_sort(rows, std::ranges::greater{}, &LimitRow::ratio);

  Figure figure;
  double least = 0.5, greatest = 2;
  for (const auto& row : rows) {
    const bool fails = row.ratio > 1;
    figure.y.rows.push_back(row.name);
    figure.bars.push_back(
        {.row = static_cast<double>(figure.bars.size()),
         .from = 1,
         .to = row.ratio,
         .colour = fails ? unstable : stable,
         .fill = fails ? Fill::hatched : Fill::solid,
         .marker = fails ? Marker::cross : Marker::circle,
         .text = fmt::format("{:.{}f}", row.ratio, row.ratio < 0.1 || std::abs(row.ratio - 1) < 0.02 ? 3 : 2)});
    least = std::min(least, row.ratio), greatest = std::max(greatest, row.ratio);
  }
  figure.x = {.title = "time step / exact limit  [-]",
              .logarithmic = true,
              .low = least / std::pow(greatest / least, 0.15),  // room for the numbers beyond the bars
              .high = greatest * std::pow(greatest / least, 0.15)};
  figure.references = {{.from = 1,
                        .to = figure.x.high,
                        .label = "unstable",
                        .colour = {unstable.red, unstable.green, unstable.blue, 0.10}},
                       {.from = proved, .to = 1, .colour = interval},
                       {.from = 1, .label = "exact limit", .colour = {0.13, 0.13, 0.15}, .dash = Dash::solid}};
  figure.keys = {{"stable", stable, Fill::solid, Marker::circle}, {"UNSTABLE", unstable, Fill::hatched, Marker::cross}};
  if (proved < 0.99) figure.keys.push_back({"proved interval of the limit", interval});
  figure.height = 130 + 22 * static_cast<double>(std::max<std::size_t>(rows.size(), 1));
  figure.width = 640;
  return figure;
}

}  // namespace eg
