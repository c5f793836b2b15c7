#pragma once
// Scene files: TOML in SI units, read once, checked fully. What comes out is a Scene that needs no further checks.
#include <string>
#include <string_view>
#include <vector>

#include "base/error.hpp"
#include "state/scene.hpp"

namespace eg {

/// Keys replaced from outside, each "KEY=VALUE": "specimen.count=300", "stage[1].until={steps=100}" (elements counted
/// from 1; VALUE as in TOML, or a plain word). Scene::text then begins with a line `settings = […]` that holds them, so
/// that a snapshot tells of them and gives the same scene again.
using SceneSettings = std::vector<std::string>;

/// Reads and checks the scene file, with the settings in the place of what it says. Throws InputError, one line
/// "file:line: key = value rule; remedy", for the first fault: bad syntax, unknown or missing key, wrong type, value
/// out of range, keys that contradict each other.
Scene read_scene(const std::string& path, const SceneSettings& = {});

/// The same for a text at hand; `file` stands in messages and is where relative paths start from.
Scene parse_scene(std::string_view text, const std::string& file = "<memory>", const SceneSettings& = {});

/// The error "file:line: subject rule; remedy" for what shows only when the scene is put to use, with the line of `key`
/// (dotted, e.g. "specimen.path") in the scene's text where it stands there.
InputError scene_error(const Scene&, std::string_view key, std::string_view subject, std::string_view rule,
                       std::string_view remedy = {});

/// Path of a file that the scene names, relative to the scene file unless absolute.
std::string resolve_path(const Scene&, const std::string& path);

}  // namespace eg
