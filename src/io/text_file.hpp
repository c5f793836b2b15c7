#pragma once
// Whole files in and out.
#include <functional>
#include <string>
#include <string_view>

namespace eg {

/// The bytes of a file. Throws InputError when it cannot be read.
std::string read_file(const std::string& path);

/// Writes through a neighbouring temporary file and renames it, so that `path` is never seen half written: `write` gets
/// the temporary name. Whatever it throws is passed on after the temporary file is removed. Throws RunError when the
/// renaming fails.
void replace_file(const std::string& path, const std::function<void(const std::string& temporary)>& write);

/// replace_file() with the given bytes. Throws RunError when they cannot be written.
void write_file(const std::string& path, std::string_view bytes);

}  // namespace eg
