#include "state/grading_preset.hpp"

namespace eg {

std::optional<Grading> grading_preset(std::string_view name) {
  if (name != "toyoura") return {};
  Grading toyoura;
  toyoura.kind = Grading::Kind::table;
  toyoura.passing = {{.100e-3, 0},   {.125e-3, .07}, {.150e-3, .20}, {.175e-3, .36},
                     {.200e-3, .55}, {.250e-3, .88}, {.300e-3, .97}, {.425e-3, 1}};
  toyoura.min_radius = .050e-3;
  toyoura.max_radius = .2125e-3;
  return toyoura;
}

std::vector<std::string> grading_preset_names() { return {"toyoura"}; }

}  // namespace eg
