#pragma once
// Strict reading of a TOML table, a line a key: what was asked for is known, what is left over is an error. Private to
// the scene reader, the only part that sees toml++.
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/vec.hpp"

namespace eg {

enum class Need { optional, required };

/// The numbers that a key may take; infinities and NaN never.
struct Range {
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
  bool low_open = true, high_open = true;

  bool holds(double x) const;
  std::string rule() const;  ///< "must lie in (-1, 0.5)"
};

inline constexpr Range any_number{};
inline constexpr Range positive{.low = 0};
inline constexpr Range non_negative{.low = 0, .low_open = false};
constexpr Range closed(double low, double high) { return {low, high, false, false}; }
constexpr Range open(double low, double high) { return {low, high, true, true}; }
constexpr Range from_below(double low, double high) { return {low, high, false, true}; }
constexpr Range above_up_to(double low, double high) { return {low, high, true, false}; }
inline constexpr Range counting = closed(1, 1e15);  ///< whole numbers that a double holds exactly

/// One table of a scene file. Each getter asks for one key: it returns whether the key is there and leaves `out` alone
/// when it is not; a required key that is missing, a wrong type or a value out of range throws InputError with file and
/// line. finish(), called last, throws for keys that nobody asked for.
class TomlReader {
 public:
  /// Of the file itself. The table must outlive the reader.
  TomlReader(const toml::table& table, std::string file) : table_(&table), file_(std::move(file)) {}

  /// Asking is enough to make a key known: a reader that chooses between keys asks for all of them first, so that
  /// messages about misspelt, missing and unknown keys know them all.
  bool has(std::string_view key) const { return find(key) != nullptr; }
  bool number(std::string_view key, double& out, const Range& = any_number, Need = Need::optional) const;
  bool number(std::string_view key, std::optional<double>& out, const Range&) const;
  /// A whole number; the range must lie within that of T.
  template <class T>
  requires std::is_arithmetic_v<T>
  bool integer(std::string_view key, T& out, const Range& range, Need need = Need::optional) const {
    double x = 0;
    const bool given = whole_number(key, x, range, need);
    if (given) out = static_cast<T>(x);
    return given;
  }
  bool flag(std::string_view key, bool& out) const;
  bool text(std::string_view key, std::string& out, Need = Need::optional) const;
  /// A text of letters, digits, '-' and '_' only: it becomes part of file names.
  bool name(std::string_view key, std::string& out, Need = Need::optional) const;
  bool choice(std::string_view key, std::string& out, const std::vector<std::string>& names,
              Need = Need::optional) const;
  template <class E>
  bool choice(std::string_view key, E& out, const std::vector<std::pair<std::string, E>>& meaning,
              Need need = Need::optional) const {
    std::vector<std::string> names;
    for (const auto& [word, value] : meaning) names.push_back(word);
    std::string word;
    const bool given = choice(key, word, names, need);
    if (given) out = std::ranges::find(meaning, word, &std::pair<std::string, E>::first)->second;
    return given;
  }
  /// An array of exactly out.size() numbers.
  bool numbers(std::string_view key, std::span<double> out, const Range& = any_number, Need = Need::optional) const;
  /// A vector of the scene's dimension; the third component of a 2D one is 0.
  bool vector(std::string_view key, int dimension, Vec3& out, Need = Need::optional) const;
  /// The same, made a unit vector; one without length throws.
  bool direction(std::string_view key, int dimension, Vec3& out, Need = Need::optional) const;
  /// An array of arrays of two numbers.
  bool pairs(std::string_view key, std::vector<std::array<double, 2>>& out) const;
  /// An array of texts out of `names`.
  bool choices(std::string_view key, std::vector<std::string>& out, const std::vector<std::string>& names,
               Need = Need::optional) const;
  /// An array of texts.
  bool texts(std::string_view key, std::vector<std::string>& out) const;
  std::optional<TomlReader> table(std::string_view key, Need = Need::optional) const;
  /// The tables of an array of tables, [[key]].
  std::vector<TomlReader> tables(std::string_view key) const;
  /// Every entry of this table, which must be tables, in the order of the file.
  std::vector<std::pair<std::string, TomlReader>> named_tables() const;
  bool is_text(std::string_view key) const;
  bool is_table(std::string_view key) const;

  /// The error for the value of `key` (for the table itself when `key` is empty).
  InputError error(std::string_view key, std::string_view rule, std::string_view remedy = {}) const;
  void finish() const;

 private:
  /// How messages name a table.
  struct Name {
    std::string path;                           ///< "stage[1].hold", as settings from outside take it; "": the file
    std::string header;                         ///< "stage.hold", as in the file
    std::string place = "the top of the file";  ///< "[contact]", "[[stage]] number 1" or "hold of [[stage]] number 1"
    bool in_array = false;                      ///< it, or a table around it, is an element of an array
  };
  TomlReader(const toml::table& table, std::string file, Name name)
      : table_(&table), file_(std::move(file)), name_(std::move(name)) {}
  const toml::node* find(std::string_view key) const;
  const toml::node* find(std::string_view key, Need) const;
  bool whole_number(std::string_view key, double& out, const Range&, Need) const;
  const toml::array* array(std::string_view key, Need) const;
  InputError unknown(std::string_view key, std::string_view remedy) const;
  std::string full(std::string_view key) const;
  std::string element(std::string_view key, std::size_t k) const;  ///< counted from 1
  std::string header(std::string_view key) const;
  InputError error_at(const toml::node&, std::string_view subject, std::string_view rule,
                      std::string_view remedy = {}) const;
  double checked_number(const toml::node&, const std::string& subject, const Range&) const;
  std::string checked_text(const toml::node&, const std::string& subject) const;
  std::string checked_choice(const toml::node&, const std::string& subject, const std::vector<std::string>&) const;

  const toml::table* table_;
  std::string file_;
  Name name_;
  mutable std::set<std::string, std::less<>> known_;  ///< keys asked for so far
};

/// InputError on one line whatever the file holds: control characters are shown as '?'.
InputError one_line_error(std::string_view file, long line, std::string_view subject, std::string_view rule,
                          std::string_view remedy = {});

}  // namespace eg
