#include <gtest/gtest.h>

#include "base/error.hpp"
#include "io/history.hpp"
#include "io/text_file.hpp"
#include "scratch.hpp"

namespace {

const std::vector<eg::HistoryColumn> columns{{"time", "s"}, {"mean stress", "Pa"}};

void append(eg::History& history, std::uint64_t step) {
  const std::array values{0.1 * static_cast<double>(step), 1e5 / static_cast<double>(step + 1)};
  history.append(step, values);
}

class HistoryFile : public testing::Test {
 protected:
  const Scratch scratch;
  const std::string path = scratch / "history.csv";
};

TEST_F(HistoryFile, EveryRowIsOnDiskAtOnce) {
  auto history = eg::History::create(path, columns);
  EXPECT_EQ(eg::read_file(path), "step [-],time [s],mean stress [Pa]\n");
  append(history, 3);
  EXPECT_EQ(eg::read_file(path), "step [-],time [s],mean stress [Pa]\n3,0.30000000000000004,25000\n");
}

TEST_F(HistoryFile, AResumedHistoryEqualsAnUnbrokenOne) {
  {
    auto whole = eg::History::create(path, columns);
    for (std::uint64_t step = 0; step <= 120; step += 10) append(whole, step);
  }
  const std::string unbroken = eg::read_file(path);
  eg::write_file(path, unbroken.substr(0, unbroken.size() - 5));  // killed while it wrote the last row
  auto resumed = eg::History::resume(path, columns, 95);          // the snapshot is older than the last rows
  EXPECT_TRUE(eg::read_file(path).find("\n90,") != std::string::npos);
  EXPECT_TRUE(eg::read_file(path).find("\n100,") == std::string::npos);
  for (std::uint64_t step = 100; step <= 120; step += 10) append(resumed, step);
  EXPECT_EQ(eg::read_file(path), unbroken);
}

TEST_F(HistoryFile, ResumesWithoutAFileAndKeepsTheRowOfTheStepItself) {
  auto first = eg::History::resume(path, columns, 10);
  append(first, 20);
  const std::string before = eg::read_file(path);
  eg::History::resume(path, columns, 20);
  EXPECT_EQ(eg::read_file(path), before);
}

TEST_F(HistoryFile, RefusesAnotherHeader) {
  eg::History::create(path, {{"time", "ms"}});
  EXPECT_THROW(eg::History::resume(path, columns, 0), eg::InputError);
}

TEST_F(HistoryFile, ReadsBackWhatWasWritten) {
  {
    auto history = eg::History::create(path, columns);
    append(history, 3), append(history, 7);
  }
  eg::write_file(path, eg::read_file(path) + "9,0.9");  // a run that is still writing
  const auto table = eg::read_history(path);
  ASSERT_EQ(table.columns.size(), 3u);
  EXPECT_EQ(table.columns[2].name, "mean stress");
  EXPECT_EQ(table.columns[2].unit, "Pa");
  EXPECT_EQ(table.find("time", path), 1u);
  EXPECT_EQ(table.values[0], (std::vector<double>{3, 7}));
  EXPECT_EQ(table.values[1], (std::vector{0.1 * 3, 0.1 * 7}));
  EXPECT_EQ(table.values[2][1], 1e5 / 8);
  EXPECT_THROW(table.find("tim", path), eg::InputError);
  for (const char* wrong : {"", "1 2 3\n", "a [-],b [-]\n1\n", "a [-]\nx\n"}) {
    eg::write_file(path, wrong);
    EXPECT_THROW(eg::read_history(path), eg::InputError) << wrong;
  }
}

}  // namespace
