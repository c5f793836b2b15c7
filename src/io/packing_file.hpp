#pragma once
// Packings as text, fully periodic: a line `Lx Ly Lz`, then a line `x y z r` for every grain (2D: `Lx Ly`, `x y r`).
// Metres; # starts a comment; numbers are separated by blanks.
#include <string>
#include <string_view>

#include "state/packing.hpp"

namespace eg {

/// Reads a packing; `wrap`: centres outside the cell are wrapped into it, as suits a periodic one but not walls. Throws
/// InputError (file:line) for what is no packing.
Packing read_packing(const std::string& path, bool wrap = true);

/// The same for a text at hand; `file` stands in messages.
Packing parse_packing(std::string_view text, const std::string& file = "<memory>", bool wrap = true);

/// Writes the packing so that read_packing() gives back the same numbers; `comment` becomes # lines at the top.
/// Periodicity is not stored. Throws RunError when the file cannot be written.
void write_packing(const std::string& path, const Packing&, std::string_view comment = {});

}  // namespace eg
