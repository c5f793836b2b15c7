#include "io/toml_parse.hpp"

#include <algorithm>

#include "io/toml_reader.hpp"

namespace eg {

namespace {

constexpr auto none = std::string_view::npos;

bool beyond_ascii(char c) { return static_cast<unsigned char>(c) >= 0x80; }

/// The quotes that open a text at the beginning of `rest`: one or three.
std::string_view opening(std::string_view rest) {
  const bool three = rest.size() >= 3 && rest[1] == rest[0] && rest[2] == rest[0];
  return rest.substr(0, three ? 3 : 1);
}

/// Offset of the first character beyond ASCII that is neither in a text nor in a comment. TOML has no place for one,
/// but toml++ 3.3 (its bug 190) runs into undefined behaviour on some of them; likewise after a
/// backslash that ends a line of a text.
std::size_t misplaced(std::string_view text) {
  std::string_view quotes;
  bool comment = false;
  for (std::size_t k = text.starts_with("\xEF\xBB\xBF") ? 3 : 0; k < text.size(); ++k) {
    const char c = text[k];
    if (comment) {
      comment = c != '\n';
    } else if (quotes.empty()) {
      if (beyond_ascii(c)) return k;
      comment = c == '#';
      if (c == '"' || c == '\'') k += (quotes = opening(text.substr(k))).size() - 1;
    } else if (c == '\\' && quotes[0] == '"') {
      const auto next = text.find_first_not_of(" \t\r\n", k + 1);
      if (next != none && next > k + 1 && beyond_ascii(text[next])) return next;
      ++k;
    } else if (text.substr(k).starts_with(quotes)) {
      k += quotes.size() - 1;
      for (int extra = 0; extra < 2 && quotes.size() == 3 && text.substr(k + 1).starts_with(c); ++extra) ++k;
      quotes = {};
    }
  }
  return none;
}

}  // namespace

toml::table parse_toml(std::string_view text, const std::string& file) {
  const std::string_view subject = "is not valid TOML:";
  if (const auto at = misplaced(text); at != none)
    throw one_line_error(file, 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'),
                         subject, "a character beyond ASCII stands outside quotes and comments", "put it in quotes");
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& e) {
    throw one_line_error(file, static_cast<long>(e.source().begin.line), subject, e.description());
  }
}

}  // namespace eg
