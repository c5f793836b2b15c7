// The cases of lattices in membranes, in small blocks.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/case_run.hpp"

namespace {

using eg::test::CaseRun;

/// Peak of asin (σ1 − σ3)/(σ1 + σ3) after the first stage [degrees].
double peak_angle(const CaseRun& run, const char* axial) {
  const auto one = run.column(axial), three = run.column("membrane_stress"), stage = run.column("stage");
  double most = 0;
  for (std::size_t k = 0; k < one.size(); ++k)
    if (stage[k] > 1 && three[k] > 0) most = std::max(most, (one[k] - three[k]) / (one[k] + three[k]));
  return std::asin(most) * 180 / std::numbers::pi;
}

double peak_of_block(const char* name, const char* cells) {
  const CaseRun run(name, "--set 'specimen.cells=" + std::string(cells) + "' --set 'stage[2].until.displacement=4'");
  return run.complete() ? peak_angle(run, "z_high_stress") : 0;
}

TEST(Membranes, HexagonalRods) {
  const CaseRun run("hexagonal_biaxial", "");
  ASSERT_TRUE(run.complete());
  EXPECT_NEAR(peak_angle(run, "y_high_stress"), 43.29, 1.0);     // tan 60° tan(60° + 12.1°)
  EXPECT_NEAR(peak_angle(run, "y_high_outer_stress"), 41, 2.0);  // O'Sullivan et al. (2003)
}

TEST(Membranes, RodsOfUnequalFriction) {
  const CaseRun run("hexagonal_biaxial", R"(--set 'contact.friction_scatter={per="contact",deviation=0.2555}')");
  ASSERT_TRUE(run.complete());
  EXPECT_NEAR(peak_angle(run, "y_high_outer_stress"), 37, 2.0);
}

TEST(Membranes, FaceCentredBalls) { EXPECT_NEAR(peak_of_block("fcc_triaxial", "[4,4,6]"), 24.60, 1.0); }

TEST(Membranes, RhombicBalls) { EXPECT_NEAR(peak_of_block("rhombic_triaxial", "[4,2,5]"), 41.58, 2.0); }

TEST(Membranes, RhombicBallsInPlaneStrain) {
  EXPECT_NEAR(peak_of_block("rhombic_plane_strain", "[4,2,5]"), 40.0, 2.0);  // laboratory; no closed form
}

}  // namespace
