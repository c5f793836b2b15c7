// The cases of the laboratory, with grains twice as large and so an eighth of their number.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/case_run.hpp"

namespace {

using eg::test::CaseRun;

TEST(DirectShear, ReducedBoxReachesItsStrength) {
  const CaseRun run(
      "direct_shear",
      "--set specimen.count=1400 --set specimen.grading.radius=2e-3 --set stage[3].body.lower.velocity=[0.1,0,0] "
      "--set stage[3].until.displacement=2e-3");
  ASSERT_TRUE(run.complete());
  const auto shear = run.column("lower_force_x"), lid = run.column("lid_force_z"), stage = run.column("stage"),
             moved = run.column("lower_moved_x");
  double sum = 0, rows = 0;  // few grains: the mean around the peak, not the highest row

  for (std::size_t k = 0; k < shear.size(); ++k)
    if (stage[k] == 3 && moved[k] > 0.5e-3) sum -= shear[k] / lid[k], rows += 1;
  EXPECT_NEAR(std::atan(sum / rows) * 180 / std::numbers::pi, 24, 3);
  EXPECT_NEAR(run.column("lid_stress").back(), 164e3, 0.05 * 164e3);
}

TEST(PlaneStrain, ReducedCalibrationPeaksAndDilates) {
  const CaseRun run("plane_strain_calibration",  // so few grains between walls lie loosely: without friction in
                                                 // preparation their porosity is .40
                    "--set specimen.count=1200 --set stage[1].friction=0 --set stage[2].friction=0 "
                    "--set stage[3].until.displacement=1.2e-3");
  ASSERT_TRUE(run.complete());
  const auto axial = run.column("z_high_stress"), lateral = run.column("y_high_stress"), e = run.column("void_ratio"),
             stage = run.column("stage");
  double most = 0, densest = 9;
  for (std::size_t k = 0; k < axial.size(); ++k)
    if (stage[k] == 3) most = std::max(most, axial[k]), densest = std::min(densest, e[k]);
  EXPECT_NEAR(most, 1150e3, 0.15 * 1150e3);
  EXPECT_NEAR(lateral.back(), 275e3, 0.01 * 275e3);
  EXPECT_GT(e.back(), densest + 5e-3);
}

// The middle of all rows of two specimens: now and then one slips at once, and its rings are flung.
TEST(SimpleShear, ReducedRingsAreInBalanceWhileGrainsSlide) {
  std::vector<double> shares;
  for (const int seed : {1, 2}) {
    const CaseRun run(
        "simple_shear_rings",
        fmt::format(
            "--set specimen.scale=2 --set specimen.count=1200 --set stage[4].until.displacement=8e-4 --set seed={}",
            seed));
    ASSERT_TRUE(run.complete());
    const auto balance = run.column("ring_resultant_share"), sliding = run.column("sliding_fraction"),
               shear = run.column("cap_force_x"), moved = run.column("cap_moved_x"), stage = run.column("stage");
    for (std::size_t k = 0; k < stage.size(); ++k)
      if (stage[k] == 4 && moved[k] > 2e-4) shares.push_back(balance[k]);  // once they have begun to move
    EXPECT_GT(sliding.back(), 0.3);
    EXPECT_LT(shear.back(), 0);  // the grains hold the cap back
    EXPECT_NEAR(run.column("cap_stress").back(), 50e3, 0.05 * 50e3);
  }
  ASSERT_GT(shares.size(), 40u);
  const auto middle = shares.begin() + static_cast<std::ptrdiff_t>(shares.size() / 2);
  std::ranges::nth_element(shares, middle);
  EXPECT_LT(*middle, 1e-2);
}

}  // namespace
