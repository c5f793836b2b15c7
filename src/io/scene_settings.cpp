#include "io/scene_settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "io/toml_parse.hpp"
#include "io/toml_reader.hpp"

namespace eg {

namespace {

bool in_key(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
}
bool in_word(char c) { return in_key(c) || c == '.' || c == ':' || c == '/'; }

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  return first == text.npos ? "" : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// A copy whose keys stand on line 0 (copies of values do so anyway).
toml::table placeless(const toml::table& table) {
  toml::table copy;
  for (const auto& [key, node] : table)
    node.visit([&, name = key.str()](const auto& value) {
      if constexpr (toml::is_table<decltype(value)>)
        copy.insert_or_assign(name, placeless(value));
      else
        copy.insert_or_assign(name, value);
    });
  return copy;
}

/// One part of a path: `name`, or `name[index]` with an index from 1 (0: none).
struct Step {
  std::string name;
  std::size_t index = 0;
};

class Setting {
 public:
  Setting(const std::string& text, const std::string& file) : text_(text), file_(file) {
    const auto equals = text_.find('=');
    if (equals == text_.npos) fail("has no value", "write KEY=VALUE, for example specimen.count=300");
    read_path(trimmed(std::string_view(text_).substr(0, equals)));
    read_value(trimmed(std::string_view(text_).substr(equals + 1)));
  }

  void apply(toml::table& scene) const {
    toml::table* table = &scene;
    for (std::size_t k = 0; k + 1 < path_.size(); ++k) table = &enter(*table, path_[k]);
    const Step& last = path_.back();
    if (last.index == 0)
      value().visit([&](const auto& v) { table->insert_or_assign(last.name, v); });
    else
      value().visit([&](const auto& v) { array(*table, last).replace(array(*table, last).cbegin() + place(last), v); });
  }

 private:
  [[noreturn]] void fail(std::string_view rule, std::string_view remedy) const {
    throw one_line_error(file_, 0, fmt::format("the setting \"{}\"", text_), rule, remedy);
  }

  void read_path(std::string_view path) {
    for (std::size_t at = 0; at <= path.size();) {
      const auto end = std::min(path.find('.', at), path.size());
      path_.push_back(read_step(path.substr(at, end - at)));
      at = end + 1;
    }
  }
  Step read_step(std::string_view part) const {
    Step step{std::string(part.substr(0, part.find('['))), 0};
    const auto rest = part.substr(step.name.size());
    if (!rest.empty()) {
      const char* digits = rest.data() + 1;
      const char* end = rest.data() + rest.size() - 1;
      const auto [stop, error] = std::from_chars(digits, end, step.index);
      if (rest.back() != ']' || stop != end || error != std::errc() || step.index == 0)
        fail("has an index that is not a number from 1", "write stage[1] for the first stage");
    }
    if (step.name.empty() || !std::ranges::all_of(step.name, in_key))
      fail("has no dotted path of keys before \"=\"", "write for example specimen.count=300");
    return step;
  }

  void read_value(std::string_view text) {
    const bool word = !text.empty() && std::ranges::all_of(text, in_word);
    try {
      value_ = placeless(parse_toml(fmt::format("v = {}", text), file_));
    } catch (const InputError&) {
      if (!word) fail("has no TOML value after \"=\"", "write a number, true, false, [list], {table} or \"text\"");
      value_.insert_or_assign("v", std::string(text));
    }
    if (value_.size() != 1) fail("holds more than one value", "give every setting a --set of its own");
  }
  const toml::node& value() const { return *value_.get("v"); }

  toml::array& array(toml::table& table, const Step& step) const {
    toml::array* all = table.get_as<toml::array>(step.name);
    if (!all) fail(fmt::format("takes \"{}\" for an array, which it is not", step.name), "leave the index out");
    if (step.index > all->size())
      fail(fmt::format("asks for element {} of {}", step.index, all->size()), "count from 1");
    return *all;
  }
  static std::ptrdiff_t place(const Step& step) { return static_cast<std::ptrdiff_t>(step.index) - 1; }

  toml::table& enter(toml::table& table, const Step& step) const {
    toml::node* node = step.index > 0 ? array(table, step).get(step.index - 1) : table.get(step.name);
    if (!node) node = &table.insert_or_assign(step.name, toml::table{}).first->second;
    if (node->is_array())
      fail(fmt::format("does not say which \"{0}\"", step.name), fmt::format("write {}[1]", step.name));
    if (!node->is_table())
      fail(fmt::format("takes \"{}\" for a table, which it is not", step.name), "shorten the path");
    return *node->as_table();
  }

  const std::string& text_;
  const std::string& file_;
  std::vector<Step> path_;
  toml::table value_;  ///< under the key "v"
};

}  // namespace

void apply_setting(toml::table& scene, const std::string& setting, const std::string& file) {
  Setting(setting, file).apply(scene);
}

}  // namespace eg
