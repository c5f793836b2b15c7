#pragma once
// Gradings of known sands, by name.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "state/scene.hpp"

namespace eg {

/// "toyoura", a digitised and so approximate curve of Toyoura sand. Nothing for another name.
std::optional<Grading> grading_preset(std::string_view name);

/// The names grading_preset() knows.
std::vector<std::string> grading_preset_names();

}  // namespace eg
