#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "base/error.hpp"
#include "report/limit_chart.hpp"
#include "report/plot.hpp"

namespace eg {
namespace {

struct Drawn : testing::Test {
  // Named after the test: CTest runs several at a time.
  std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "eigengrain_plot" /
                                 testing::UnitTest::GetInstance()->current_test_info()->name();
  ~Drawn() override { std::filesystem::remove_all(folder); }

  std::string draw(const Figure& figure, const std::string& name) const {
    write_figure(figure, folder / name);
    std::ifstream in(folder / name, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
  }
};

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

Figure curve(std::vector<double> x, std::vector<double> y) {
  Figure figure;
  figure.title = "Δt/√(m/k)";
  figure.series = {{.label = "curve", .x = std::move(x), .y = std::move(y)}};
  return figure;
}

const std::string first_colour = "rgb(0%,36%,64%)";

TEST_F(Drawn, EndingChoosesTheFormat) {
  const auto figure = curve({0, 1, 2}, {1, 4, 9});
  EXPECT_EQ(draw(figure, "a.svg").substr(0, 5), "<?xml");
  EXPECT_EQ(draw(figure, "a.png").substr(1, 3), "PNG");
  EXPECT_EQ(draw(figure, "a.pdf").substr(0, 4), "%PDF");
  EXPECT_THROW(write_figure(figure, folder / "a.jpg"), InputError);
  EXPECT_THROW(write_figure(figure, "/proc/nowhere/a.svg"), InputError);
  EXPECT_THROW(write_figure(figure, "/proc/nowhere/a.png"), InputError);
}

TEST_F(Drawn, MapAndShadedPointsWithTheirScale) {
  Figure figure;
  figure.map = {.x_high = 2, .columns = 2, .rows = 1, .value = {0, 1}};
  EXPECT_EQ(count(draw(figure, "none.svg"), "<image"), 0u);  // nothing says what a value looks like
  figure.shades = Shades{.title = "share [-]"};
  EXPECT_GE(count(draw(figure, "map.svg"), "<image"), 2u);  // the map and the bar
  figure.map = {};
  figure.shaded = {.x = {0, 1, 2}, .y = {0, 1, 4}, .value = {0, 0.5, 1}};
  figure.x.marks = {{0, "Γ"}, {2, "X"}};
  EXPECT_EQ(draw(figure, "a.png").substr(1, 3), "PNG");
}

TEST(Shades, BlendEvenlyAndStopAtTheEnds) {
  const Shades shades{.low = 2, .high = 4, .colours = {{0, 0, 0}, {1, 0.5, 0}}};
  EXPECT_DOUBLE_EQ(shades.of(3).red, 0.5);
  EXPECT_DOUBLE_EQ(shades.of(9).green, 0.5);
  EXPECT_DOUBLE_EQ(shades.of(-1).red, 0);
  EXPECT_DOUBLE_EQ(Shades{}.of(0).red, 1);  // white where there is nothing
}

TEST_F(Drawn, SameFigureSameFile) {
  const auto figure = curve({0, 1, 2}, {1, 4, 9});
  EXPECT_EQ(draw(figure, "a.png"), draw(figure, "b.png"));
  EXPECT_NE(draw(figure, "a.png"), draw(curve({0, 1, 2}, {1, 5, 9}), "b.png"));
}

TEST_F(Drawn, NotFiniteBreaksTheCurve) {
  const auto whole = draw(curve({0, 1, 2, 3, 4}, {0, 1, 2, 3, 4}), "a.svg");
  const auto broken = draw(curve({0, 1, 2, 3, 4}, {0, 1, NAN, 3, 4}), "b.svg");
  EXPECT_EQ(count(broken, first_colour), count(whole, first_colour) + 1);
}

TEST_F(Drawn, LogarithmicAxisLeavesOutWhatHasNoLogarithm) {
  auto figure = curve({0, 1, 10, 100}, {-1, 1, 10, 100});
  figure.x.logarithmic = figure.y.logarithmic = true;
  const auto svg = draw(figure, "a.svg");
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
}

TEST_F(Drawn, SeriesDifferWithoutColour) {
  auto figure = curve({0, 1}, {0, 1});
  const auto one = draw(figure, "a.svg");
  figure.series.push_back({.label = "second", .x = {0, 1}, .y = {1, 0}});
  EXPECT_GT(count(draw(figure, "b.svg"), "stroke-dasharray"), count(one, "stroke-dasharray"));
}

TEST_F(Drawn, EmptyFigureAndUnequalSeries) {
  EXPECT_FALSE(draw({}, "a.svg").empty());
  EXPECT_THROW(write_figure(curve({0, 1}, {0}), folder / "a.svg"), InputError);
}

TEST(LimitChart, SortsRowsAndTellsUnstableFromStable) {
  const auto figure = limit_chart({{"small", 0.2}, {"none", NAN}, {"large", 1.4}, {"zero", 0}, {"limit", 1}}, 0.98);
  EXPECT_EQ(figure.y.rows, (std::vector<std::string>{"large", "limit", "small"}));
  ASSERT_EQ(figure.bars.size(), 3u);
  EXPECT_EQ(figure.bars[0].fill, Fill::hatched);
  EXPECT_EQ(figure.bars[1].fill, Fill::solid);
  EXPECT_EQ(figure.bars[2].fill, Fill::solid);
  EXPECT_NE(figure.bars[0].marker, figure.bars[1].marker);
  EXPECT_EQ(figure.bars[2].text, "0.20");
  for (const auto& bar : figure.bars) {
    EXPECT_EQ(bar.from, 1);
    EXPECT_GT(bar.to, figure.x.low);
    EXPECT_LT(bar.to, figure.x.high);
  }
}

TEST_F(Drawn, LimitChartIsOnOneSideOfTheLimitOrTheOther) {
  const std::string unstable = "rgb(78%,20%,5%)", stable = "rgb(13%,38%,62%)";
  const auto safe = draw(limit_chart({{"a", 0.5}, {"b", 0.7}}), "a.svg");
  const auto mixed = draw(limit_chart({{"a", 0.5}, {"b", 1.7}}), "b.svg");
  EXPECT_GT(count(safe, stable), count(mixed, stable));
  EXPECT_LT(count(safe, unstable), count(mixed, unstable));
  EXPECT_FALSE(draw(limit_chart({}), "c.png").empty());
}

}  // namespace
}  // namespace eg
