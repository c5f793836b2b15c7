#include "report/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace eg {

std::size_t text_places(const std::string& text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

namespace {

constexpr const char* nothing = "—";

std::string shown(const Value& value, int digits) {
  if (const auto* word = std::get_if<std::string>(&value)) return *word;
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return fmt::format("{}", *whole);
  const auto* number = std::get_if<double>(&value);
  return number && !std::isnan(*number) ? fmt::format("{:.{}g}", *number, digits) : nothing;
}

nlohmann::json as_json(const Value& value) {
  if (const auto* word = std::get_if<std::string>(&value)) return *word;
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return *whole;
  const auto* number = std::get_if<double>(&value);
  return number && std::isfinite(*number) ? nlohmann::json(*number) : nlohmann::json();
}

std::string padded(const std::string& text, std::size_t width, bool right) {
  const std::string blanks(width - text_places(text), ' ');
  return right ? blanks + text : text + blanks;
}

}  // namespace

void Table::add(std::vector<Value> row) {
  assert(row.size() == columns_.size());
  rows_.push_back(std::move(row));
}

std::string Table::text() const {
  std::vector<std::string> lines(rows_.size() + 2);
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    const auto& column = columns_[c];
    std::vector<std::string> parts{column.title.empty() ? column.key : column.title, ""};
    if (!column.unit.empty()) parts[0] += fmt::format(" [{}]", column.unit);
    bool right = !rows_.empty();
    for (const auto& row : rows_) {
      parts.push_back(shown(row[c], column.digits));
      right = right && !std::holds_alternative<std::string>(row[c]);
    }
    std::size_t width = 0;
    for (const auto& part : parts) width = std::max(width, text_places(part));
    for (std::size_t places = 0; places < width; ++places) parts[1] += "─";
    for (std::size_t k = 0; k < parts.size(); ++k) lines[k] += (c ? "  " : "") + padded(parts[k], width, right);
  }
  std::string text;
  for (auto& line : lines) {
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + '\n';
  }
  return text;
}

nlohmann::json Table::json() const {
  auto list = nlohmann::json::array();
  for (const auto& row : rows_) {
    nlohmann::json object;
    for (std::size_t c = 0; c < columns_.size(); ++c) object[columns_[c].key] = as_json(row[c]);
    list.push_back(std::move(object));
  }
  return list;
}

}  // namespace eg
