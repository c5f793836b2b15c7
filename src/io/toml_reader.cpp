#include "io/toml_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

namespace eg {

namespace {

std::string quoted(std::string_view text) {
  constexpr std::size_t longest = 60;
  return text.size() <= longest ? fmt::format("\"{}\"", text) : fmt::format("\"{}…\"", text.substr(0, longest));
}

/// A value as the file might write it; "" for arrays and tables.
std::string shown(const toml::node& node) {
  if (const auto* v = node.as_string()) return quoted(v->get());
  if (const auto* v = node.as_integer()) return fmt::format("{}", v->get());
  if (const auto* v = node.as_floating_point()) return fmt::format("{}", v->get());
  if (const auto* v = node.as_boolean()) return v->get() ? "true" : "false";
  return {};
}

std::string listed(const std::vector<std::string>& names) {
  std::vector<std::string> all;
  for (const auto& name : names) all.push_back(quoted(name));
  return fmt::format("{}", fmt::join(all, ", "));
}

std::string joined(const std::string& path, std::string_view key) {
  return path.empty() || key.empty() ? path + std::string(key) : fmt::format("{}.{}", path, key);
}

long line_of(const toml::node& node) { return static_cast<long>(node.source().begin.line); }

}  // namespace

bool Range::holds(double x) const {
  return std::isfinite(x) && (low_open ? x > low : x >= low) && (high_open ? x < high : x <= high);
}

std::string Range::rule() const {
  if (std::isinf(low) && std::isinf(high)) return "must be a finite number";
  if (std::isinf(high)) return fmt::format("must be finite and {} {}", low_open ? ">" : ">=", low);
  return fmt::format("must lie in {}{}, {}{}", low_open ? '(' : '[', low, high, high_open ? ')' : ']');
}

InputError one_line_error(std::string_view file, long line, std::string_view subject, std::string_view rule,
                          std::string_view remedy) {
  std::string text = input_error(file, line, subject, rule, remedy).what();
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') c = '?';
  return InputError(text);
}

std::string TomlReader::full(std::string_view key) const { return joined(name_.path, key); }

std::string TomlReader::header(std::string_view key) const { return joined(name_.header, key); }

std::string TomlReader::element(std::string_view key, std::size_t k) const {
  return fmt::format("{}[{}]", full(key), k + 1);
}

InputError TomlReader::error_at(const toml::node& node, std::string_view subject, std::string_view rule,
                                std::string_view remedy) const {
  const std::string value = shown(node);
  return one_line_error(file_, line_of(node),
                        value.empty() ? std::string(subject) : fmt::format("{} = {}", subject, value), rule, remedy);
}

InputError TomlReader::error(std::string_view key, std::string_view rule, std::string_view remedy) const {
  const toml::node* node = table_->get(key);
  if (key.empty() || !node) return one_line_error(file_, line_of(*table_), full(key), rule, remedy);
  return error_at(*node, full(key), rule, remedy);
}

InputError TomlReader::unknown(std::string_view key, std::string_view remedy) const {
  const auto entry = table_->find(key);
  return one_line_error(file_, static_cast<long>(entry->first.source().begin.line), full(key), "is not a known key",
                        remedy);
}

const toml::node* TomlReader::find(std::string_view key) const {
  known_.emplace(key);
  return table_->get(key);
}

const toml::node* TomlReader::find(std::string_view key, Need need) const {
  const toml::node* node = find(key);
  if (node || need == Need::optional) return node;
  std::vector<std::string> left_over;  // a missing key is most often there, misspelt
  for (const auto& [other, value] : *table_)
    if (!known_.contains(other.str())) left_over.emplace_back(other.str());
  if (const auto misspelt = nearest(key, left_over); !misspelt.empty())
    throw unknown(misspelt, fmt::format("did you mean \"{}\"?", key));
  throw one_line_error(file_, line_of(*table_), full(key), "is missing",
                       fmt::format("add \"{}\" to {}", key, name_.place));
}

void TomlReader::finish() const {
  const toml::key* first = nullptr;
  for (const auto& [key, value] : *table_)
    if (!known_.contains(key.str()) && (!first || key.source().begin < first->source().begin)) first = &key;
  if (!first) return;
  const std::vector<std::string> names(known_.begin(), known_.end());
  const auto meant = nearest(first->str(), names);
  throw unknown(first->str(), meant.empty() ? "known here: " + fmt::format("{}", fmt::join(names, ", "))
                                            : fmt::format("did you mean \"{}\"?", meant));
}

double TomlReader::checked_number(const toml::node& node, const std::string& subject, const Range& range) const {
  if (node.is_string()) {
    const std::string text = node.as_string()->get();
    throw error_at(
        node, subject, "must be a number",
        text.starts_with('.') ? "write 0" + text : "write it in SI units, without quotes and without a unit");
  }
  if (!node.is_number()) throw error_at(node, subject, "must be a number");
  const double x = node.is_integer() ? static_cast<double>(node.as_integer()->get()) : node.as_floating_point()->get();
  if (!range.holds(x)) throw error_at(node, subject, range.rule());
  return x;
}

bool TomlReader::number(std::string_view key, double& out, const Range& range, Need need) const {
  const toml::node* node = find(key, need);
  if (node) out = checked_number(*node, full(key), range);
  return node;
}

bool TomlReader::number(std::string_view key, std::optional<double>& out, const Range& range) const {
  double x = 0;
  const bool given = number(key, x, range);
  if (given) out = x;
  return given;
}

bool TomlReader::whole_number(std::string_view key, double& out, const Range& range, Need need) const {
  const bool given = number(key, out, range, need);
  if (given && out != std::floor(out)) throw error(key, "must be a whole number");
  return given;
}

bool TomlReader::flag(std::string_view key, bool& out) const {
  const toml::node* node = find(key);
  if (!node) return false;
  if (!node->is_boolean()) throw error(key, "must be true or false", "write it without quotes");
  out = node->as_boolean()->get();
  return true;
}

std::string TomlReader::checked_text(const toml::node& node, const std::string& subject) const {
  if (!node.is_string()) throw error_at(node, subject, "must be a text", "put it in quotes");
  return node.as_string()->get();
}

bool TomlReader::text(std::string_view key, std::string& out, Need need) const {
  const toml::node* node = find(key, need);
  if (!node) return false;
  out = checked_text(*node, full(key));
  if (out.empty()) throw error(key, "must not be empty");
  return true;
}

bool TomlReader::name(std::string_view key, std::string& out, Need need) const {
  if (!text(key, out, need)) return false;
  const auto fits = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  };
  if (!std::ranges::all_of(out, fits)) throw error(key, "must be made of letters, digits, - and _");
  return true;
}

std::string TomlReader::checked_choice(const toml::node& node, const std::string& subject,
                                       const std::vector<std::string>& names) const {
  const std::string word = checked_text(node, subject);
  if (std::ranges::find(names, word) != names.end()) return word;
  const auto meant = nearest(word, names);
  throw error_at(node, subject, "must be one of " + listed(names),
                 meant.empty() ? "" : fmt::format("did you mean \"{}\"?", meant));
}

bool TomlReader::choice(std::string_view key, std::string& out, const std::vector<std::string>& names,
                        Need need) const {
  const toml::node* node = find(key, need);
  if (node) out = checked_choice(*node, full(key), names);
  return node;
}

const toml::array* TomlReader::array(std::string_view key, Need need) const {
  const toml::node* node = find(key, need);
  if (!node) return nullptr;
  if (!node->is_array()) throw error(key, "must be an array", "put it in brackets [ ]");
  return node->as_array();
}

bool TomlReader::numbers(std::string_view key, std::span<double> out, const Range& range, Need need) const {
  const toml::array* values = array(key, need);
  if (!values) return false;
  if (values->size() != out.size())
    throw error(key, fmt::format("must hold {} numbers, not {}", out.size(), values->size()));
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = checked_number(*values->get(k), element(key, k), range);
  return true;
}

bool TomlReader::vector(std::string_view key, int dimension, Vec3& out, Need need) const {
  std::array<double, 3> x{};
  if (!numbers(key, std::span(x).first(static_cast<std::size_t>(dimension)), any_number, need)) return false;
  out = {x[0], x[1], x[2]};
  return true;
}

bool TomlReader::direction(std::string_view key, int dimension, Vec3& out, Need need) const {
  if (!vector(key, dimension, out, need)) return false;
  const double length = norm(out);
  if (!(length > 0) || !std::isfinite(length)) throw error(key, "must have a length above 0");
  out *= 1 / length;
  return true;
}

bool TomlReader::pairs(std::string_view key, std::vector<std::array<double, 2>>& out) const {
  const toml::array* rows = array(key, Need::optional);
  if (!rows) return false;
  for (std::size_t k = 0; k < rows->size(); ++k) {
    const std::string subject = element(key, k);
    const toml::array* row = rows->get(k)->as_array();
    if (!row || row->size() != 2) throw error_at(*rows->get(k), subject, "must be an array of two numbers");
    out.push_back({checked_number(*row->get(0), subject + "[1]", any_number),
                   checked_number(*row->get(1), subject + "[2]", any_number)});
  }
  return true;
}

bool TomlReader::choices(std::string_view key, std::vector<std::string>& out, const std::vector<std::string>& names,
                         Need need) const {
  const toml::array* words = array(key, need);
  if (!words) return false;
  for (std::size_t k = 0; k < words->size(); ++k) out.push_back(checked_choice(*words->get(k), element(key, k), names));
  return true;
}

bool TomlReader::texts(std::string_view key, std::vector<std::string>& out) const {
  const toml::array* all = array(key, Need::optional);
  if (!all) return false;
  for (std::size_t k = 0; k < all->size(); ++k) out.push_back(checked_text(*all->get(k), element(key, k)));
  return true;
}

std::optional<TomlReader> TomlReader::table(std::string_view key, Need need) const {
  const toml::node* node = find(key, need);
  if (!node) return {};
  if (!node->is_table())
    throw error(key, "must be a table",
                name_.in_array ? fmt::format("write {} = {{ … }}", key)
                               : fmt::format("write [{0}] or {0} = {{ … }}", full(key)));
  const std::string place =
      name_.in_array ? fmt::format("{} of {}", key, name_.place) : fmt::format("[{}]", header(key));
  return TomlReader(*node->as_table(), file_, Name{full(key), header(key), place, name_.in_array});
}

std::vector<TomlReader> TomlReader::tables(std::string_view key) const {
  const toml::node* node = find(key);
  if (!node) return {};
  const toml::array* rows = node->as_array();
  const std::string remedy = fmt::format("write [[{}]]", header(key));
  if (!rows) throw error(key, "must be an array of tables", remedy);
  std::vector<TomlReader> all;
  for (std::size_t k = 0; k < rows->size(); ++k) {
    const toml::node& row = *rows->get(k);
    const std::string subject = element(key, k);
    if (!row.is_table()) throw error_at(row, subject, "must be a table", remedy);
    std::string place = fmt::format("[[{}]] number {}", header(key), k + 1);
    if (name_.in_array) place += " of " + name_.place;
    all.push_back(TomlReader(*row.as_table(), file_, Name{subject, header(key), place, true}));
  }
  return all;
}

std::vector<std::pair<std::string, TomlReader>> TomlReader::named_tables() const {
  std::vector<const toml::key*> keys;
  for (const auto& [key, value] : *table_) keys.push_back(&key);
  const auto place = [](const toml::key* key) {  // what a setting added has no line and comes last
    const auto& begin = key->source().begin;
    return std::pair(begin.line > 0 ? begin.line : std::numeric_limits<toml::source_index>::max(), begin.column);
  };
  std::ranges::stable_sort(keys, {}, place);
  std::vector<std::pair<std::string, TomlReader>> all;
  for (const auto* key : keys) all.emplace_back(std::string(key->str()), *table(key->str()));
  return all;
}

bool TomlReader::is_text(std::string_view key) const {
  const toml::node* node = find(key);
  return node && node->is_string();
}
bool TomlReader::is_table(std::string_view key) const {
  const toml::node* node = find(key);
  return node && node->is_table();
}

}  // namespace eg
