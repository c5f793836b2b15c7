#include "io/history.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <charconv>
#include <filesystem>
#include <string_view>

#include "base/error.hpp"
#include "io/text_file.hpp"

namespace eg {

namespace {

std::string header_of(const std::vector<HistoryColumn>& columns) {
  std::string header = "step [-]";
  for (const auto& column : columns) header += fmt::format(",{} [{}]", column.name, column.unit);
  return header + '\n';
}

/// Length of the part of `text` to keep: whole rows up to `step`.
std::size_t kept_length(std::string_view text, std::size_t header, std::uint64_t step) {
  std::size_t start = header;
  for (std::size_t end; (end = text.find('\n', start)) != std::string_view::npos; start = end + 1) {
    std::uint64_t row = 0;
    const auto parsed = std::from_chars(text.data() + start, text.data() + end, row);
    if (parsed.ec != std::errc{} || row > step) break;
  }
  return start;
}

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  for (std::size_t start = 0, end = 0; end != std::string_view::npos; start = end + 1) {
    end = line.find(',', start);
    cells.push_back(line.substr(start, end == std::string_view::npos ? end : end - start));
  }
  return cells;
}

/// "name [unit]"
HistoryColumn column_of(std::string_view cell, const std::string& path) {
  const auto open = cell.rfind(" [");
  if (open == std::string_view::npos || !cell.ends_with(']'))
    throw input_error(path, 1, "the header", "is not that of a history: `step [-],time [s],…`", "name a history.csv");
  return {std::string(cell.substr(0, open)), std::string(cell.substr(open + 2, cell.size() - open - 3))};
}

}  // namespace

std::size_t HistoryTable::find(const std::string& name, const std::string& path) const {
  std::vector<std::string> names;
  for (const auto& column : columns) names.push_back(column.name);
  const auto found = std::ranges::find(names, name);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  const std::string meant = nearest(name, names);
  throw input_error(path, 1, name, "is not a column of this history",
                    meant.empty() ? "its first line names them" : fmt::format("did you mean \"{}\"?", meant));
}

HistoryTable read_history(const std::string& path) {
  const std::string text = read_file(path);
  HistoryTable table;
  const std::string_view all = text;
  std::size_t start = 0;
  long line = 0;
  for (std::size_t end; (end = all.find('\n', start)) != std::string_view::npos; start = end + 1) {
    const auto cells = cells_of(all.substr(start, end - start));
    if (++line == 1) {
      for (const auto cell : cells) table.columns.push_back(column_of(cell, path));
      table.values.resize(cells.size());
      continue;
    }
    if (cells.size() != table.columns.size())
      throw input_error(path, line, "this row",
                        fmt::format("has {} cells for {} columns", cells.size(), table.columns.size()));
    for (std::size_t k = 0; k < cells.size(); ++k) {
      double value = 0;
      if (std::from_chars(cells[k].data(), cells[k].data() + cells[k].size(), value).ec != std::errc{})
        throw input_error(path, line, table.columns[k].name, "is not a number");
      table.values[k].push_back(value);
    }
  }
  if (line == 0) throw input_error(path, 0, "the file", "holds no history", "name a history.csv");
  return table;
}

History::History(const std::string& path, const char* mode, std::size_t columns)
    : path_(path), file_(std::fopen(path.c_str(), mode)), columns_(columns) {
  if (!file_) throw RunError(path + ": cannot be written; check that the folder exists");
}

void History::write(const std::string& row) {
  if (std::fwrite(row.data(), 1, row.size(), file_.get()) != row.size() || std::fflush(file_.get()) != 0)
    throw RunError(path_ + ": cannot be written; check that the disk has room");
}

History History::create(const std::string& path, const std::vector<HistoryColumn>& columns) {
  History history(path, "wb", columns.size());
  history.write(header_of(columns));
  return history;
}

History History::resume(const std::string& path, const std::vector<HistoryColumn>& columns, std::uint64_t step) {
  if (!std::filesystem::exists(path)) return create(path, columns);
  const std::string text = read_file(path), header = header_of(columns);
  if (!text.starts_with(header))
    throw input_error(path, 1, "the header", "is not that of this run",
                      "move the file away or resume in another folder");
  std::filesystem::resize_file(path, kept_length(text, header.size(), step));
  return History(path, "ab", columns.size());
}

void History::append(std::uint64_t step, std::span<const double> values) {
  assert(values.size() == columns_);
  std::string row = fmt::format("{}", step);
  for (const double value : values) row += fmt::format(",{}", value);
  write(row + '\n');
}

}  // namespace eg
