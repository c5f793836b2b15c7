// Strength of regular packings in periodic cells against closed forms: the sharpest test of the whole solver.
#include <gtest/gtest.h>

#include <cmath>

#include "support/case_run.hpp"

namespace {

using namespace eg::test;

const double root2 = std::sqrt(2.0), root3 = std::sqrt(3.0);

std::string reduced(double friction) {
  return "--set stage[2].until.axial_strain=0.002 --set stage[2].record.every_strain=2e-6 --set "
         "material.grain.friction=" +
         std::to_string(friction);
}

/// Largest ratio of the driven stress to σx.
double peak(const CaseRun& run, const char* driven) {
  const auto top = run.column(driven), side = run.column("stress_x");
  double most = 0;
  for (std::size_t k = 0; k < top.size(); ++k) most = std::max(most, top[k] / side[k]);
  return most;
}

void expect_closed_ledger(const CaseRun& run) {
  const double work = run.column("outside_work").back();
  for (const double residual : run.column("energy_residual")) ASSERT_LT(std::abs(residual), 1e-5 * work);
}

TEST(Strength, FaceCentredCubicTriaxial) {
  for (const char* law : {"linear", "hertz-mindlin"})
    for (const double mu : {0.0963, 0.25}) {
      SCOPED_TRACE(std::string(law) + " " + std::to_string(mu));
      const CaseRun run("fcc_triaxial_periodic", reduced(mu) + " --set contact.law=" + law);
      ASSERT_TRUE(run.complete());
      EXPECT_LT(run["largest_overlap"], 2.2e-4);
      EXPECT_NEAR(peak(run, "stress_z") / (2 * (1 + mu) / (1 - mu)), 1, 2e-3);
      const auto z = run.column("strain_z"), x = run.column("strain_x"), top = run.column("stress_z"),
                 side = run.column("stress_x"), sliding = run.column("sliding_fraction"),
                 coordination = run.column("coordination");
      // The stages before do not count: a cube's height over its width is 1 at their end.
      std::size_t past = 0;
      for (std::size_t k = 0; k < z.size(); ++k) {
        if (sliding[k] < 1 || coordination[k] > 8) continue;
        const double beta = std::atan(std::exp(x[k] - z[k]));
        ASSERT_NEAR(top[k] / side[k] / (2 * std::tan(beta) * std::tan(beta + std::atan(mu))), 1, 1e-6);
        ++past;
      }
      EXPECT_GT(past, 100u);
      expect_closed_ledger(run);
    }
}

TEST(Strength, CloseLayersTriaxial) {
  for (const char* lattice : {"hcp", "fcc-111"})
    for (const double mu : {0.0963, 0.25}) {
      SCOPED_TRACE(std::string(lattice) + " " + std::to_string(mu));
      const CaseRun run("rhombic_triaxial_periodic", reduced(mu) + " --set specimen.lattice=" + lattice);
      ASSERT_TRUE(run.complete());
      EXPECT_NEAR(peak(run, "stress_z") / ((4 + 2 * root2 * mu) / (1 - root2 * mu)), 1, 3e-3);
      expect_closed_ledger(run);
    }
}

TEST(Strength, FaceCentredCubicPlaneStrain) {
  for (const double mu : {0.0963, 0.25}) {
    SCOPED_TRACE(mu);
    const CaseRun run("fcc_plane_strain_periodic", reduced(mu));
    ASSERT_TRUE(run.complete());
    EXPECT_NEAR(peak(run, "stress_z") / (2 * (root3 + root2 * mu) / (root3 - 2 * root2 * mu)), 1, 5e-3);
    for (const double y : run.column("strain_y"))
      ASSERT_LT(y, 1e-3);  // of the compression; the shear leaves it as it is
    expect_closed_ledger(run);
  }
}

TEST(Strength, HexagonalBiaxial) {
  for (const double mu : {0.0963, 0.25}) {
    SCOPED_TRACE(mu);
    const CaseRun run("hexagonal_periodic", reduced(mu));
    ASSERT_TRUE(run.complete());
    EXPECT_NEAR(peak(run, "stress_y") / (root3 * std::tan(std::atan(root3) + std::atan(mu))), 1, 2e-3);
    expect_closed_ledger(run);
  }
}

}  // namespace
