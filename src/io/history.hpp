#pragma once
// Histories: a CSV file whose rows grow with the run. First column `step [-]`, then the columns named by the user of
// it.
#include <cstdint>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace eg {

struct HistoryColumn {
  std::string name, unit;  ///< header `name [unit]`; neither holds a comma or a line break
};

/// A history as it was written, column by column.
struct HistoryTable {
  std::vector<HistoryColumn> columns;       ///< the first one is `step`
  std::vector<std::vector<double>> values;  ///< values[column][row]

  /// The column of that name; throws InputError, naming the nearest one, when there is none.
  std::size_t find(const std::string& name, const std::string& path) const;
};
/// Throws InputError when the file is no history; a last row cut short is left out.
HistoryTable read_history(const std::string& path);

/// Every row is on disk when append() returns. Throws RunError when the file cannot be written.
class History {
 public:
  /// A new file; one of that name is replaced.
  static History create(const std::string& path, const std::vector<HistoryColumn>&);
  /// Goes on after `step`: rows of later steps, and a row cut short, are dropped. Creates the file when there is none.
  /// Throws InputError when the file has other columns.
  static History resume(const std::string& path, const std::vector<HistoryColumn>&, std::uint64_t step);

  /// One value a column, numbers written so that reading gives back the same bits.
  void append(std::uint64_t step, std::span<const double> values);

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  History(const std::string& path, const char* mode, std::size_t columns);
  void write(const std::string& row);

  std::string path_;
  std::unique_ptr<std::FILE, Close> file_;
  std::size_t columns_;
};

}  // namespace eg
