#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>

#include "base/progress.hpp"

namespace eg {
namespace {

/// What the body writes to a stream that is not a terminal.
template <class Body>
std::string written(Body&& body) {
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::tmpfile(), std::fclose);
  body(file.get());
  std::rewind(file.get());
  std::string text;
  std::array<char, 4096> part{};
  while (const auto n = std::fread(part.data(), 1, part.size(), file.get())) text.append(part.data(), n);
  return text;
}

TEST(Duration, ReadsLikeAWatch) {
  EXPECT_EQ(duration_text(0.4249), "0.42 s");
  EXPECT_EQ(duration_text(9.97), "10 s");
  EXPECT_EQ(duration_text(59.7), "1 min 00 s");
  EXPECT_EQ(duration_text(200), "3 min 20 s");
  EXPECT_EQ(duration_text(7500), "2 h 05 min");
}

TEST(Progress, FileIsNoTerminal) {
  written([](std::FILE* out) { EXPECT_EQ(Progress::style_of(out), Progress::Style::lines); });
}

TEST(Progress, QuietWritesNothingAndAsksForNoNote) {
  const auto text = written([](std::FILE* out) {
    Progress progress("work", 10, "steps", Progress::Style::quiet, out);
    progress.every(0, 0);
    progress.update(5, []() -> std::string { throw "asked"; });
  });
  EXPECT_EQ(text, "");
}

TEST(Progress, ShortWorkIsSilentAndAsksForNoNote) {
  const auto text = written([](std::FILE* out) {
    Progress progress("work", 1e5, "steps", Progress::Style::lines, out);
    for (int step = 0; step < 100; ++step) progress.update(step, []() -> std::string { throw "asked"; });
  });
  EXPECT_EQ(text, "");
}

TEST(Progress, LinesHoldShareTimeLeftRateAndNote) {
  const auto text = written([](std::FILE* out) {
    Progress progress("settle", 200, "steps", Progress::Style::lines, out);
    progress.every(0, 1e9);
    progress.update(50, [] { return std::string("p = 3 Pa"); });
    progress.update(60);  // too soon for a second line
  });
  EXPECT_EQ(text.substr(0, 12), "settle  25 %");
  EXPECT_NE(text.find(" left"), std::string::npos);
  EXPECT_NE(text.find("steps/s  p = 3 Pa\n"), std::string::npos);
  EXPECT_NE(text.find("settle: 60 steps in "), std::string::npos);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 2);
  EXPECT_EQ(text.find('\r'), std::string::npos);
}

TEST(Progress, UnknownTotalShowsCountOnly) {
  const auto text = written([](std::FILE* out) {
    Progress progress("run", 0, "steps", Progress::Style::lines, out);
    progress.every(0, 1e9);
    progress.update(1234);
  });
  EXPECT_EQ(text.substr(0, 14), "run 1234 steps");
  EXPECT_EQ(text.find('%'), std::string::npos);
  EXPECT_EQ(text.find("left"), std::string::npos);
}

TEST(Progress, ShareBesideTheCount) {
  const auto text = written([](std::FILE* out) {
    Progress progress("run", 0, "steps", Progress::Style::lines, out);
    progress.every(1e9, 1e9);
    const auto note = [] { return std::string(); };
    progress.update(9e9, 0.5, note);  // a resumed run begins far from zero: its rate and time left do not count that
    progress.every(0, 1e9);
    progress.update(9e9, 0.75, note);
    progress.every(0, 1e9);
    progress.update(9e9 + 1, Progress::unknown, note);
  });
  EXPECT_EQ(text.substr(0, 9), "run  75 %");
  EXPECT_NE(text.find(" left  0 steps/s\n"), std::string::npos) << text;
  EXPECT_NE(text.find("\nrun 9000000001 steps  "), std::string::npos) << text;
}

TEST(Progress, WithoutUnitOnlyTheShareIsShown) {
  const auto text = written([](std::FILE* out) {
    Progress progress("search", 1, "", Progress::Style::lines, out);
    progress.every(0, 1e9);
    progress.update(0.5);
  });
  EXPECT_EQ(text.substr(0, 12), "search  50 %");
  EXPECT_EQ(text.find("/s"), std::string::npos) << text;
  EXPECT_NE(text.find("search: done in "), std::string::npos) << text;
}

TEST(Progress, ClearLeavesAnEmptyLine) {
  const auto text = written([](std::FILE* out) {
    Progress progress("x", 4, "u", Progress::Style::bar, out);
    progress.clear();  // nothing shown yet
    progress.every(0, 1e9);
    progress.update(2);
    progress.clear();
    std::fputs("note\n", out);
  });
  const auto end = text.find("\rnote\n");
  ASSERT_NE(end, std::string::npos) << text;
  EXPECT_EQ(text.rfind("\r", end - 1) + 1, text.find_last_not_of(' ', end - 1) + 1) << text;
  EXPECT_EQ(text[0], '\r');
}

TEST(Progress, BarCoversTheLineBefore) {
  const auto text = written([](std::FILE* out) {
    Progress progress("x", 4, "u", Progress::Style::bar, out);
    progress.every(0, 0);
    progress.update(2, [] { return std::string(40, '#'); });
    progress.update(8);  // past the end stays at 100 %
    progress.finish();
    progress.finish();
  });
  EXPECT_NE(text.find("[============            ]  50 %"), std::string::npos);
  EXPECT_NE(text.find("[========================] 100 %"), std::string::npos);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\r'), 3);
  const auto first = text.find('\r', 1), second = text.find('\r', first + 1);
  EXPECT_GE(second - first, first);  // blanks wipe the longer line before
}

}  // namespace
}  // namespace eg
