// Cases that compare ways to hold the sides of a specimen, reduced.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/case_run.hpp"

namespace {

using eg::test::CaseRun;
using eg::test::json;
using eg::test::output;

/// Peak of asin (σ1 − σ3)/(σ1 + σ3) in the last stage [degrees].
double peak_angle(const CaseRun& run, const char* axial, const char* lateral) {
  const auto one = run.column(axial), three = run.column(lateral), stage = run.column("stage");
  double most = 0;
  for (std::size_t k = 0; k < one.size(); ++k)
    if (stage[k] == 3) most = std::max(most, (one[k] - three[k]) / (one[k] + three[k]));
  return std::asin(most) * 180 / std::numbers::pi;
}

TEST(Sides, DisksInMembraneAndBetweenWalls) {
  const std::string smaller = "--set specimen.count=500 --set 'specimen.box=[0.0195,0.039]' ";
  const auto peak_of = [&](const std::string& settings, const char* lateral) {
    const CaseRun run("disks_biaxial", smaller + settings);
    EXPECT_TRUE(run.complete());
    if (!run.complete()) return 0.0;
    EXPECT_NEAR(run.column(lateral).back(), 100e3, 0.02 * 100e3);
    return peak_angle(run, "y_high_stress", lateral);
  };
  const double soft = peak_of("--set 'stage[3].until.displacement=2e-3'", "membrane_stress");
  const double hard = peak_of(
      "--set 'stage[2]={name=\"confine\",body={x_high={stress=100e3},y_high={stress=100e3}},"
      "until={stress_error=1e-3,unbalanced_force=1e-3}}' "
      "--set 'stage[3]={name=\"shear\",body={x_high={stress=100e3},y_high={velocity=[0,-0.08]}},"
      "until={displacement=2e-3},record={every_displacement=2e-5}}'",
      "x_high_stress");
  EXPECT_GT(soft, 18);
  EXPECT_NEAR(soft, hard, 5);
}

TEST(Sides, BondedSpheresBreakInTheMembrane) {
  const CaseRun run("bonded_triaxial",
                    "--set specimen.scale=2 --set specimen.count=2100 --set 'stage[3].until.displacement=1.6e-3'");
  ASSERT_TRUE(run.complete());
  EXPECT_GT(peak_angle(run, "lid_stress", "membrane_stress"), 20);
  const auto bonds = run.column("bonds"), pulled = run.column("bonds_pulled"), cut = run.column("bonds_cut");
  EXPECT_GT(*std::ranges::max_element(bonds), 1000);
  EXPECT_GT(pulled.back() + cut.back(), 10);
}

TEST(Sides, InsideRigidWallsThePackingIsDenser) {
  const CaseRun run("sample_size",
                    "--set specimen.count=800 --set 'stage[2].body.z_high.velocity=[0,0,-0.1]' "
                    "--set 'stage[2].until.displacement=3e-4'");
  ASSERT_TRUE(run.complete());
  EXPECT_NEAR(run.column("x_high_stress").back(), 500e3, 0.02 * 500e3);
  const json zones =
      json::parse(output("measure " + run.file("final.h5") + " --json --zones x:3,y:3,z:3"), nullptr, false);
  ASSERT_TRUE(zones.is_object());
  const json& all = zones.at("zones").at(0);
  EXPECT_LT(all.at("table").at(13).at("void_ratio").get<double>(), 0.97 * all.at("void_ratio").get<double>());
}

}  // namespace
