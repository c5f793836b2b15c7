#pragma once
// One table for two readers: aligned text for the eye, JSON with stable keys for a program.
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <variant>
#include <vector>

namespace eg {

/// "—" (nothing to say), a word, a whole number, a number.
using Value = std::variant<std::monostate, std::string, std::int64_t, double>;

struct Column {
  std::string key;      ///< name in JSON; part of the interface, does not change
  std::string title{};  ///< over the column; empty: the key
  std::string unit{};   ///< shown in square brackets; JSON is in the same unit
  int digits = 4;       ///< significant digits of numbers in text; JSON keeps all of them
};

class Table {
 public:
  explicit Table(std::vector<Column> columns) : columns_(std::move(columns)) {}

  /// Needs one value a column.
  void add(std::vector<Value> row);
  std::size_t rows() const { return rows_.size(); }

  /// Lines with header and rule; words to the left, numbers to the right, two blanks between columns.
  std::string text() const;
  /// [{key: value, …}, …] in the order of the rows; a number that is not finite and "nothing" are null.
  nlohmann::json json() const;

 private:
  std::vector<Column> columns_;
  std::vector<std::vector<Value>> rows_;
};

/// Places a text takes on the screen: code points of UTF-8.
std::size_t text_places(const std::string& text);

}  // namespace eg
