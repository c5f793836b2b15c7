// The ugly cases: every proved interval holds the limit that the whole spectrum, or stepping, gives.
#include <gtest/gtest.h>

#include "extremes.hpp"

namespace eg {
namespace {

class Extremes : public testing::TestWithParam<test::Extreme> {};

TEST_P(Extremes, IntervalHoldsTheTruthOrRefusesClearly) {
  const auto row = test::work_out(GetParam());
  if (!row.refusal.empty()) {
    EXPECT_EQ(row.refusal.find('\n'), std::string::npos);
    EXPECT_NE(row.refusal.find(';'), std::string::npos) << "no remedy: " << row.refusal;
    return;
  }
  EXPECT_TRUE(row.holds()) << row.interval.dt_safe << " … " << row.interval.dt_limit_upper << " against "
                           << row.truth_low << " … " << row.truth_high << " by " << row.truth;
  EXPECT_LE(row.interval.dt_safe, row.interval.dt_limit_upper);
  EXPECT_GT(row.interval.dt_safe, 0);
}

INSTANTIATE_TEST_SUITE_P(All, Extremes, testing::ValuesIn(test::extremes(false)));

}  // namespace
}  // namespace eg
