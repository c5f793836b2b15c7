#include "io/toml_parse.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "io/toml_reader.hpp"

namespace eg {

namespace {

constexpr std::string_view not_toml = "is not valid TOML:";

bool beyond_ascii(char c) { return static_cast<unsigned char>(c) >= 0x80; }

/// The quotes that open a text at the beginning of `rest`: one or three.
std::string_view opening(std::string_view rest) {
  const bool three = rest.size() >= 3 && rest[1] == rest[0] && rest[2] == rest[0];
  return rest.substr(0, three ? 3 : 1);
}

struct CodePoint {
  unsigned long value = 0;
  std::size_t length = 0;  ///< bytes; 0: not UTF-8
};

CodePoint decode(std::string_view text) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
  const std::size_t length = byte(0) >= 0xF0 ? 4 : byte(0) >= 0xE0 ? 3 : 2;
  if (byte(0) < 0xC0 || byte(0) >= 0xF8 || text.size() < length) return {};
  unsigned long value = byte(0) & (0xFFu >> (length + 1));
  for (std::size_t k = 1; k < length; ++k) {
    if ((byte(k) & 0xC0) != 0x80) return {};
    value = value << 6 | (byte(k) & 0x3F);
  }
  return {value, length};
}

/// Rewrites a scene in ASCII on the same lines: toml++ 3.3 (its bug 190) runs into undefined behaviour on some
/// characters beyond it. In comments they become '?', in texts within double quotes escapes; elsewhere TOML has no
/// place for them, but for texts within single quotes, which are refused too.
class ToAscii {
 public:
  ToAscii(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  std::string run() {
    if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
    while (at_ < text_.size())
      if (comment_)
        in_comment();
      else if (quotes_.empty())
        outside();
      else
        in_quotes();
    return std::move(out_);
  }

 private:
  void keep(std::size_t n) {
    n = std::min(n, text_.size() - at_);
    out_ += text_.substr(at_, n);
    at_ += n;
  }
  [[noreturn]] void refuse(std::string_view rule, std::string_view remedy) const {
    throw one_line_error(file_, 1 + std::count(out_.begin(), out_.end(), '\n'), not_toml, rule, remedy);
  }
  void in_comment() {
    const char c = text_[at_++];
    comment_ = c != '\n';
    out_ += beyond_ascii(c) ? '?' : c;
  }
  void outside() {
    const char c = text_[at_];
    if (beyond_ascii(c))
      refuse("a character beyond ASCII stands outside quotes and comments", "put it in double quotes");
    comment_ = c == '#';
    if (c == '"' || c == '\'') quotes_ = opening(text_.substr(at_));
    keep(quotes_.empty() ? 1 : quotes_.size());
  }
  void in_quotes() {
    const char c = text_[at_];
    if (beyond_ascii(c)) {
      escape();
    } else if (c == '\\' && quotes_[0] == '"') {
      if (at_ + 1 < text_.size() && beyond_ascii(text_[at_ + 1]))
        refuse("a backslash stands before a character beyond ASCII", "write \\\\ for a backslash");
      keep(2);
    } else if (text_.substr(at_).starts_with(quotes_)) {
      const bool three = quotes_.size() == 3;
      keep(quotes_.size());
      for (int more = 0; more < 2 && three && text_.substr(at_).starts_with(c); ++more) keep(1);  // """a"""""
      quotes_ = {};
    } else {
      keep(1);
    }
  }
  void escape() {
    if (quotes_[0] == '\'') refuse("a character beyond ASCII stands in single quotes", "use double quotes");
    const auto [value, length] = decode(text_.substr(at_));
    if (length == 0) refuse("the text is not UTF-8", "save the file as UTF-8");
    out_ += fmt::format("\\U{:08X}", value);
    at_ += length;
  }

  std::string_view text_;
  const std::string& file_;
  std::string out_;
  std::size_t at_ = 0;
  bool comment_ = false;
  std::string_view quotes_;  ///< what opened the text that at_ is in
};

}  // namespace

toml::table parse_toml(std::string_view text, const std::string& file) {
  const bool plain = std::ranges::none_of(text, beyond_ascii);
  const std::string ascii = plain ? std::string(text) : ToAscii(text, file).run();
  try {
    return toml::parse(ascii, file);
  } catch (const toml::parse_error& e) {
    throw one_line_error(file, static_cast<long>(e.source().begin.line), not_toml, e.description());
  }
}

}  // namespace eg
