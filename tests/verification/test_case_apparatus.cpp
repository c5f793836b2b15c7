// The cases of the laboratory, with grains twice as large and so an eighth of their number.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/case_run.hpp"

namespace {

using eg::test::CaseRun;

TEST(DirectShear, ReducedBoxReachesItsStrength) {
  const CaseRun run(
      "direct_shear",
      "--set specimen.count=700 --set specimen.grading.radius=2.5e-3 --set stage[2].body.lower.velocity=[0.1,0,0] "
      "--set stage[2].until.displacement=3e-3");
  ASSERT_TRUE(run.complete());
  const auto shear = run.column("upper_force_x"), lid = run.column("lid_force_z"), stage = run.column("stage");
  double most = 0;
  for (std::size_t k = 0; k < shear.size(); ++k)
    if (stage[k] == 2) most = std::max(most, shear[k] / lid[k]);
  EXPECT_NEAR(std::atan(most) * 180 / std::numbers::pi, 24, 6);  // few grains
  EXPECT_NEAR(run.column("lid_stress").back(), 164e3, 0.05 * 164e3);
}

}  // namespace
