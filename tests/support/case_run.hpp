#pragma once
// Runs the program on a case of cases/ as a user would. A test that includes this is named test_case_*.cpp: CMake gives
// those the program's path and builds it first.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

namespace eg::test {

using nlohmann::json;

/// What the program prints with these arguments; an exit status other than 0 fails the test.
inline std::string output(const std::string& arguments) {
  const std::string command = std::string(EIGENGRAIN_PROGRAM) + " " + arguments + " 2>/dev/null";
  std::FILE* pipe = popen(command.c_str(), "r");
  std::string text;
  std::array<char, 4096> part{};
  while (const auto n = std::fread(part.data(), 1, part.size(), pipe)) text.append(part.data(), n);
  const int status = pclose(pipe);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << command;
  return text;
}

inline std::string case_file(const std::string& name) { return EIGENGRAIN_SOURCE_DIR "/cases/" + name + ".toml"; }

/// A case that is run, its results in a folder of its own.
class CaseRun {
 public:
  CaseRun(const std::string& name, const std::string& settings)
      : folder_(std::filesystem::temp_directory_path() / ("eigengrain_case_" + name + "_" + std::to_string(getpid()))) {
    const std::string text = output("run " + case_file(name) + " " + settings + " --json --out " + folder_.string());
    result_ = json::parse(text, nullptr, false);
  }
  ~CaseRun() { std::filesystem::remove_all(folder_); }
  CaseRun(const CaseRun&) = delete;
  CaseRun& operator=(const CaseRun&) = delete;

  bool complete() const { return result_.is_object(); }
  double operator[](const char* key) const { return result_.at(key).get<double>(); }
  const json& result() const { return result_; }
  std::string file(const char* name) const { return (folder_ / name).string(); }

  /// A column of the history by its name without unit.
  std::vector<double> column(const std::string& name) const {
    std::ifstream in(file("history.csv"));
    std::string line, cell;
    std::getline(in, line);
    std::size_t place = 0;
    std::istringstream head(line);
    while (std::getline(head, cell, ',') && !cell.starts_with(name + " [")) ++place;
    std::vector<double> values;
    while (std::getline(in, line)) {
      std::istringstream row(line);
      for (std::size_t k = 0; k <= place; ++k) std::getline(row, cell, ',');
      values.push_back(std::stod(cell));
    }
    return values;
  }

 private:
  std::filesystem::path folder_;
  json result_;
};

}  // namespace eg::test
