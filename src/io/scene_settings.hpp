#pragma once
// Settings: single keys of a scene replaced from outside, "specimen.count = 300". Private to the scene reader.
#include <toml++/toml.h>

#include <string>

namespace eg {

/// Puts "KEY = VALUE" into the table. KEY is a dotted path, elements of arrays counted from 1 as in messages:
/// `stage[2].until.steps`; tables on the way that are missing are made. VALUE is as in TOML, or a plain word, which is
/// taken as text. What is set stands on line 0. Throws InputError (about `file`) for a setting that cannot be read or
/// leads nowhere; whether the scene knows the key is for its reader to say.
void apply_setting(toml::table& scene, const std::string& setting, const std::string& file);

}  // namespace eg
