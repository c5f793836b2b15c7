#include "io/packing_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>
#include <span>
#include <tuple>

#include "base/error.hpp"
#include "io/text_file.hpp"

namespace eg {

namespace {

bool blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

/// A value that text can hold, cut to a length fit for a message.
std::string shown(std::string_view word) { return std::string(word.substr(0, 30)); }

/// The numbers of a text, a line at a time.
class Lines {
 public:
  Lines(std::string_view text, const std::string& file) : rest_(text), file_(file) {}

  /// Moves to the next line that holds numbers; false at the end of the text.
  bool next() {
    while (!rest_.empty()) {
      ++line_;
      const auto end = rest_.find('\n');
      ended_ = end != std::string_view::npos;
      std::string_view line = rest_.substr(0, end);
      rest_.remove_prefix(ended_ ? end + 1 : rest_.size());
      read(line.substr(0, line.find('#')));
      if (count_ > 0) return true;
    }
    return false;
  }

  std::size_t count() const { return count_; }
  double operator[](std::size_t k) const { return values_[k]; }
  /// False for a last line without line break: it may have been cut.
  bool ended() const { return ended_; }
  InputError error(std::string_view subject, std::string_view rule, std::string_view remedy = {}) const {
    return input_error(file_, line_, subject, rule, remedy);
  }

 private:
  void read(std::string_view line) {
    count_ = 0;
    const char *p = line.data(), *end = p + line.size();
    while (p = std::find_if_not(p, end, blank), p != end) {
      if (*p == '+') ++p;
      double value = 0;
      const auto [after, failure] = std::from_chars(p, end, value);
      if (failure != std::errc{} || (after != end && !blank(*after)) || !std::isfinite(value)) {
        const std::string_view word(p, static_cast<std::size_t>(std::find_if(p, end, blank) - p));
        throw error(fmt::format("\"{}\"", shown(word)), "is not a finite number", "write numbers between blanks");
      }
      if (count_ < values_.size()) values_[count_] = value;
      ++count_;
      p = after;
    }
  }

  std::string_view rest_;
  const std::string& file_;
  long line_ = 0;
  bool ended_ = true;
  std::size_t count_ = 0;
  std::array<double, 4> values_{};
};

void check_text(std::string_view text, const std::string& file) {
  if (text.starts_with("\xFD"
                       "7zXZ"))
    throw input_error(file, 0, "is packed by xz,", "but a packing is plain text", "unpack it first: unxz FILE");
  const auto odd = [](char c) { return static_cast<unsigned char>(c) < ' ' && c != '\n' && c != '\t' && c != '\r'; };
  if (std::ranges::any_of(text, odd))
    throw input_error(file, 0, "is a binary file,", "but a packing is plain text",
                      "write `Lx Ly Lz`, then `x y z r` a line");
}

/// The same point within [0, edge).
double wrapped(double x, double edge) {
  if (x >= 0 && x < edge) return x;
  const double inside = std::fmod(x, edge);
  const double shifted = inside < 0 ? inside + edge : inside;
  return shifted < edge ? shifted : 0.0;
}

Packing read_box(const Lines& line) {
  Packing packing;
  if (line.count() != 2 && line.count() != 3)
    throw line.error("the first line", fmt::format("must hold 2 or 3 numbers, not {}", line.count()),
                     "write the edges of the periodic cell, `Lx Ly Lz` (2D: `Lx Ly`)");
  packing.dimension = static_cast<int>(line.count());
  for (int k = 0; k < packing.dimension; ++k) {
    packing.box[k] = line[static_cast<std::size_t>(k)];
    if (!(packing.box[k] > 0))
      throw line.error(fmt::format("L{} = {}", "xyz"[k], packing.box[k]), "must be > 0", "edges are lengths in metres");
    packing.periodic[static_cast<std::size_t>(k)] = true;
  }
  return packing;
}

void read_grain(const Lines& line, double smallest_edge, bool wrap, Packing& packing) {
  const auto axes = static_cast<std::size_t>(packing.dimension);
  if (line.count() != axes + 1) {
    const auto rule = fmt::format("holds {} numbers, not {}", line.count(), axes + 1);
    if (!line.ended() && line.count() <= axes)
      throw line.error("the last line", rule, "the file ends in the middle of a line; get a whole copy");
    throw line.error("the line", rule, axes == 3 ? "write `x y z r`" : "write `x y r`");
  }
  const double radius = line[axes];
  if (!(radius > 0)) throw line.error(fmt::format("radius = {}", radius), "must be > 0");
  if (2 * radius > smallest_edge)
    throw line.error(fmt::format("radius = {}", radius),
                     fmt::format("makes a grain larger than the cell, whose shortest edge is {}", smallest_edge),
                     "all lengths are in metres");
  Vec3 centre;
  for (int k = 0; k < packing.dimension; ++k) {
    const double x = line[static_cast<std::size_t>(k)];
    centre[k] = wrap ? wrapped(x, packing.box[k]) : x;
  }
  packing.position.push_back(centre);
  packing.radius.push_back(radius);
}

/// Between grains at one point no force has a direction.
void check_distinct(const Packing& packing, const std::string& file) {
  std::vector<std::size_t> order(packing.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto at = [&](std::size_t i) {
    const Vec3& x = packing.position[i];
    return std::tuple(x.x, x.y, x.z, i);
  };
  std::ranges::sort(order, {}, at);
  for (std::size_t k = 1; k < order.size(); ++k) {
    const Vec3 &a = packing.position[order[k - 1]], &b = packing.position[order[k]];
    if (a.x == b.x && a.y == b.y && a.z == b.z)
      throw input_error(file, 0, fmt::format("grains {} and {}", order[k - 1] + 1, order[k] + 1),
                        "lie at one point, where no contact force has a direction", "move or remove one of them");
  }
}

}  // namespace

Packing parse_packing(std::string_view text, const std::string& file, bool wrap) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // the mark some editors put before UTF-8
  check_text(text, file);
  Lines line(text, file);
  if (!line.next())
    throw input_error(file, 0, "is an empty packing:", "it holds no numbers",
                      "write `Lx Ly Lz`, then `x y z r` a line");
  Packing packing = read_box(line);
  const double smallest =
      std::min({packing.box.x, packing.box.y, packing.dimension == 3 ? packing.box.z : packing.box.y});
  while (line.next()) read_grain(line, smallest, wrap, packing);
  if (packing.size() == 0)
    throw input_error(file, 0, "is an empty packing:", "no grain follows the cell", "write `x y z r` a line");
  check_distinct(packing, file);
  return packing;
}

Packing read_packing(const std::string& path, bool wrap) { return parse_packing(read_file(path), path, wrap); }

void write_packing(const std::string& path, const Packing& packing, std::string_view comment) {
  std::string text;
  auto out = std::back_inserter(text);
  for (std::size_t start = 0; start < comment.size();) {
    const auto end = std::min(comment.find('\n', start), comment.size());
    fmt::format_to(out, "# {}\n", comment.substr(start, end - start));
    start = end + 1;
  }
  const auto row = [&](const Vec3& v, const char* last) {
    if (packing.dimension == 3)
      fmt::format_to(out, "{} {} {}{}", v.x, v.y, v.z, last);
    else
      fmt::format_to(out, "{} {}{}", v.x, v.y, last);
  };
  row(packing.box, "\n");
  for (std::size_t i = 0; i < packing.size(); ++i) {
    row(packing.position[i], " ");
    fmt::format_to(out, "{}\n", packing.radius[i]);
  }
  write_file(path, text);
}

}  // namespace eg
