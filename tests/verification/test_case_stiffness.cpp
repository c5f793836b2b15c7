// Cases of elastic moduli through the command line, at reduced size where the full one takes long.
#include <gtest/gtest.h>

#include <cmath>

#include "support/case_run.hpp"

namespace {

using namespace eg::test;

json stiffness(const std::string& arguments) {
  return json::parse(output("stiffness --json " + arguments), nullptr, false);
}
double modulus(const json& j, std::size_t a, std::size_t b) { return j.at("moduli_Pa").at(a).at(b).get<double>(); }

TEST(CaseStiffness, FccHasTheModuliAndSpeedsOfDuffyAndMindlin) {
  const json j = stiffness(case_file("stiffness_fcc"));
  ASSERT_TRUE(j.is_object());
  EXPECT_TRUE(j.at("positive_definite").get<bool>());
  EXPECT_NEAR(modulus(j, 0, 0) / 1.0574281e9, 1, 1e-3);
  EXPECT_NEAR(modulus(j, 0, 1) / 1.7430133e7, 1, 1e-3);
  EXPECT_NEAR(modulus(j, 3, 3) / 5.2871405e8, 1, 1e-3);
  const double exact[5][3] = {{734.08, 519.08, 519.08},
                              {734.08, 519.08, 519.08},
                              {734.08, 519.08, 519.08},
                              {737.10, 519.08, 514.78},
                              {738.11, 516.22, 516.22}};
  for (std::size_t d = 0; d < 5; ++d)
    for (std::size_t w = 0; w < 3; ++w)
      EXPECT_NEAR(j.at("directions").at(d).at("speeds_m_per_s").at(w).get<double>() / exact[d][w], 1, 1e-3);
  const json stiffer = stiffness(case_file("stiffness_fcc") + " --set specimen.pressure=800e3");
  EXPECT_NEAR(modulus(stiffer, 0, 0) / modulus(j, 0, 0), 2, 2e-3);  // p^(1/3)
}

TEST(CaseStiffness, LinearSpringsAgreeWithProbing) {
  const json j = stiffness(case_file("stiffness_linear") +
                           " --probe --set specimen.count=200 --set stage[2].until.unbalanced_force=1e-5");
  ASSERT_TRUE(j.is_object());
  EXPECT_TRUE(j.at("probe").at("found").get<bool>());
  EXPECT_LE(j.at("probe").at("difference").get<double>(), 5e-3);
  for (const auto& theory : j.at("effective_medium"))
    EXPECT_GT(theory.at("shear_Pa").get<double>(), j.at("isotropic").at("shear_Pa").get<double>());
}

TEST(CaseStiffness, ShearedPackingIsStiffestAlongItsFabric) {
  const json j =
      stiffness(case_file("stiffness_sheared") + " --set specimen.count=300 --set stage[2].until.axial_strain=0.02");
  ASSERT_TRUE(j.is_object());
  EXPECT_LT(j.at("fabric_angle_deg").get<double>(), 15);
  EXPECT_GT(std::abs(j.at("principal").at("axes").at(0).at(2).get<double>()), 0.9);
  EXPECT_GT(modulus(j, 2, 2), 1.2 * modulus(j, 0, 0));
  EXPECT_LT(j.at("transversely_isotropic").at("misfit").get<double>(),
            0.7 * j.at("isotropic").at("misfit").get<double>());
}

// N ∝ overlap^2.590, ^1.583 and ^1.5 make kn ∝ N^0.614, N^0.368 and N^(1/3) (Otsubo et al. 2017); partial slip is in no
// elastic tensor.
TEST(CaseStiffness, RoughFccStiffensByTheStagesOfItsLaw) {
  for (const char* law : {"rough-hertz-mindlin", "rough-hertz-mindlin-deresiewicz", "hertz-mindlin-deresiewicz"}) {
    const auto at = [&](double pressure) {
      return stiffness(case_file("rough_surface") + " --initial --set specimen.pressure=" + std::to_string(pressure) +
                       " --set 'contact.law=\"" + law + "\"'");
    };
    // Of C11 d over N, which p d² is in proportion to: the lattice shrinks.
    const auto exponent = [&](double low, double high) {
      const json a = at(low), b = at(high);
      const double shrunk = std::log(b.at("volume").get<double>() / a.at("volume").get<double>()) / 3;
      const double force = std::log(b.at("mean_stress_Pa").get<double>() / a.at("mean_stress_Pa").get<double>());
      return (std::log(modulus(b, 0, 0) / modulus(a, 0, 0)) + shrunk) / (force + 2 * shrunk);
    };
    const bool smooth = law[0] == 'h';
    EXPECT_NEAR(exponent(3e3, 2e5), smooth ? 1. / 3 : 1.58979550 / 2.58979550, 1e-4) << law;
    EXPECT_NEAR(exponent(5e5, 2e7), smooth ? 1. / 3 : 0.58300969 / 1.58300969, 1e-4) << law;
    EXPECT_NEAR(exponent(4e7, 8e7), 1. / 3, 1e-4) << law;
  }
}

TEST(CaseStiffness, RoughRandomPackingStiffensFasterThanASmoothOne) {
  const auto stages = [](const std::string& law) {
    return json::parse(output("stiffness " + case_file("stiffness_rough") +
                              " --stages --json --set specimen.count=200 " + "--set 'contact.law=\"" + law + "\"'"),
                       nullptr, false)
        .at("stages");
  };
  const json rough = stages("rough-hertz-mindlin"), smooth = stages("hertz-mindlin");
  ASSERT_EQ(rough.size(), 9u);
  const auto exponent = [](const json& rows, std::size_t k) { return rows.at(k).at("shear_exponent").get<double>(); };
  EXPECT_GT(exponent(rough, 2), exponent(smooth, 2) + 0.1);  // 1 to 3 kPa
  EXPECT_GT(exponent(rough, 2), 0.55);
  EXPECT_LT(exponent(rough, 8), exponent(rough, 2) - 0.1);  // 1 to 3 MPa
  EXPECT_NEAR(exponent(rough, 8), exponent(smooth, 8), 0.03);
  EXPECT_NEAR(exponent(rough, 8), 1. / 3, 0.06);
}

TEST(CaseStiffness, WallsSeeASymmetricMatrix) {
  const json j = stiffness(case_file("settling_box") + " --set specimen.count=150");
  ASSERT_TRUE(j.is_object());
  EXPECT_FALSE(j.at("periodic").get<bool>());
  EXPECT_GT(modulus(j, 0, 0), 0);
  EXPECT_GT(modulus(j, 1, 1), 0);
  for (std::size_t a = 0; a < j.at("rows").size(); ++a) {
    EXPECT_GE(modulus(j, a, a), 0);
    for (std::size_t b = 0; b < a; ++b) EXPECT_EQ(modulus(j, a, b), modulus(j, b, a));
  }
}

}  // namespace
