#include "io/history.hpp"

#include <fmt/format.h>

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

}  // namespace

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
