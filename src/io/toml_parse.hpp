#pragma once
// Text to TOML table. Private to the scene reader.
#include <toml++/toml.h>

#include <string>
#include <string_view>

namespace eg {

/// Throws InputError, one line with file and line, for what is not TOML 1.0.
toml::table parse_toml(std::string_view text, const std::string& file);

}  // namespace eg
