#pragma once
// Scene files: TOML in SI units, read once, checked fully. What comes out is a Scene that needs no further checks.
#include <string>
#include <string_view>

#include "state/scene.hpp"

namespace eg {

/// Reads and checks the scene file. Throws InputError, one line "file:line: key = value rule; remedy", for the first
/// fault: bad syntax, unknown or missing key, wrong type, value out of range, keys that contradict each other.
Scene read_scene(const std::string& path);

/// The same for a text at hand; `file` stands in messages and is where relative paths start from.
Scene parse_scene(std::string_view text, const std::string& file = "<memory>");

/// Path of a file that the scene names, relative to the scene file unless absolute.
std::string resolve_path(const Scene&, const std::string& path);

}  // namespace eg
