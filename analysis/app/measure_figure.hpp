#pragma once
// Figures of what `eigengrain measure` found.
#include <string>
#include <vector>

#include "app/measure_report.hpp"

namespace eg {

/// "rose" (contacts by direction), "force-rose" (mean normal force by direction), "connectivity", "forces", "spins",
/// "fractions".
const std::vector<std::string>& measure_figures();

/// Draws one of measure_figures() into a file (.svg, .png, .pdf). Throws InputError when it cannot be written.
void draw_measure(const MeasureReport& report, const std::string& kind, const std::string& path);

}  // namespace eg
