#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "report/scale.hpp"
#include "report/ticks.hpp"

namespace eg {
namespace {

std::vector<std::string> labels(const Ticks& ticks) {
  std::vector<std::string> out;
  for (const auto& tick : ticks.ticks)
    if (!tick.label.empty()) out.push_back(tick.label);
  return out;
}

using Strings = std::vector<std::string>;

TEST(LinearTicks, StepIsOneTwoOrFiveTimesTenAndTicksStayInside) {
  for (double low : {-3.7, 0.0, 12.0, 1e6})
    for (double span : {1e-4, 0.03, 1.0, 7.0, 2.4e3, 9.9e8}) {
      const auto ticks = linear_ticks(low, low + span).ticks;
      ASSERT_GE(ticks.size(), 3u) << low << ' ' << span;
      ASSERT_LE(ticks.size(), 8u) << low << ' ' << span;
      const double step = ticks[1].value - ticks[0].value;
      const double mantissa = step / std::pow(10, std::floor(std::log10(step * (1 + 1e-6))));
      EXPECT_LT(std::min({std::abs(mantissa - 1), std::abs(mantissa - 2), std::abs(mantissa - 5)}), 1e-4) << mantissa;
      EXPECT_GE(ticks.front().value, low);
      EXPECT_LE(ticks.back().value, low + span);
    }
}

TEST(LinearTicks, Labels) {
  EXPECT_EQ(labels(linear_ticks(0, 1)), (Strings{"0.0", "0.2", "0.4", "0.6", "0.8", "1.0"}));
  EXPECT_EQ(labels(linear_ticks(-20, 30)), (Strings{"-20", "-10", "0", "10", "20", "30"}));
  EXPECT_EQ(linear_ticks(-20, 30).exponent, 0);
  const auto large = linear_ticks(0, 3e6);
  EXPECT_EQ(large.exponent, 6);
  EXPECT_EQ(labels(large), (Strings{"0.0", "0.5", "1.0", "1.5", "2.0", "2.5", "3.0"}));
  EXPECT_EQ(linear_ticks(0, 3e-4).exponent, -6);
}

TEST(LogTicks, ShortRangeNamesTwoAndFive) {
  EXPECT_EQ(labels(log_ticks(0.1, 10)), (Strings{"0.1", "0.2", "0.5", "1", "2", "5", "10"}));
  EXPECT_EQ(log_ticks(0.1, 10).ticks.size(), 19u);  // with the minor ones
}

TEST(LogTicks, LongRangeNamesDecadesAsPowers) {
  EXPECT_EQ(labels(log_ticks(2e-7, 3e-3)), (Strings{"10⁻⁶", "10⁻⁵", "10⁻⁴", "10⁻³"}));
  const auto huge = labels(log_ticks(1, 1e30));
  EXPECT_GE(huge.size(), 4u);
  EXPECT_LE(huge.size(), 11u);
}

TEST(LogTicks, VeryShortRangeIsLinear) { EXPECT_EQ(labels(log_ticks(1, 3)).front(), "1.0"); }

TEST(PowerOfTen, Digits) { EXPECT_EQ(power_of_ten(-1203), "10⁻¹²⁰³"); }

TEST(Scale, CoversItsValuesAndKeepsGivenEnds) {
  const auto linear = scale_for({}, {0.3, 9.2, NAN});
  EXPECT_LE(linear.low, 0.3);
  EXPECT_GE(linear.high, 9.2);
  EXPECT_LE(linear.high, 10);
  const auto logarithmic = scale_for({.logarithmic = true}, {-1, 0, 2, 200});
  EXPECT_GT(logarithmic.low, 1);
  EXPECT_LE(logarithmic.low, 2);
  const auto given = scale_for({.low = -5, .high = 5}, {0, 100});
  EXPECT_EQ(given.low, -5);
  EXPECT_EQ(given.high, 5);
}

TEST(Scale, OneValueOrNoneStillSpansSomething) {
  for (const bool logarithmic : {false, true})
    for (const auto& values : {std::vector<double>{}, {4.0}, {0.0}, {-2.0, -2.0}}) {
      const auto scale = scale_for({.logarithmic = logarithmic}, values);
      EXPECT_LT(scale.low, scale.high);
    }
}

TEST(Scale, PlacesEndsAndMiddle) {
  Scale scale{.low = 1, .high = 100, .logarithmic = true, .start = 50, .end = 250};
  EXPECT_NEAR(scale(1), 50, 1e-12);
  EXPECT_NEAR(scale(10), 150, 1e-12);
  EXPECT_NEAR(scale(100), 250, 1e-12);
  EXPECT_FALSE(std::isfinite(scale(0)));
  scale.logarithmic = false;
  EXPECT_NEAR(scale(50.5), 150, 1e-12);
}

}  // namespace
}  // namespace eg
