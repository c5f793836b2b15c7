// Every case of cases/ through the command line, at reduced size where the full one takes long: what its head promises
// is what comes out.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "io/snapshot.hpp"
#include "support/case_run.hpp"

namespace {

using namespace eg::test;

struct Lattice {
  const char* name;
  int dimension;
  double with_rotation, without;                  ///< exact Δt/√(m/k), infinite lattice
  double element_with_rotation, element_without;  ///< the element bound
};

class LatticeCase : public testing::TestWithParam<Lattice> {};

TEST_P(LatticeCase, GivesTheExactStep) {
  const Lattice& l = GetParam();
  const double radius = 1e-3, k = 1e6, density = 2650;
  const double mass = density * std::numbers::pi * radius * radius * (l.dimension == 3 ? 4 * radius / 3 : 1);
  const double unit = std::sqrt(mass / k);
  for (const bool rotation : {true, false}) {
    SCOPED_TRACE(rotation ? "with rotation" : "without rotation");
    const auto text =
        output("timestep --json " + case_file(std::string("lattice_") + l.name) + (rotation ? "" : " --no-rotation"));
    const json j = json::parse(text, nullptr, false);
    ASSERT_TRUE(j.is_object());
    const double exact = rotation ? l.with_rotation : l.without;
    EXPECT_NEAR(j.at("dt_safe").get<double>() / unit / exact, 1, 1e-8);
    EXPECT_NEAR(j.at("dt_limit_upper").get<double>() / unit / exact, 1, 1e-8);
    const double element = rotation ? l.element_with_rotation : l.element_without;
    for (const auto& row : j.at("estimates")) {
      if (row.at("name") != "element") continue;
      EXPECT_NEAR(row.at("dt").get<double>() / unit / element, 1, 1e-8);
    }
  }
}

// Exact values: largest Bloch frequencies of each lattice, kn = kt = k. Element bound: one contact with masses shared
// by the Z contacts of a grain, λ = 2Z (2D and 3D, no rotation), 7Z with rotation of spheres, 6Z of disks.
INSTANTIATE_TEST_SUITE_P(
    All, LatticeCase,
    testing::Values(
        Lattice{"sc", 3, 2 / std::sqrt(20.), 2 / std::sqrt(12.), 2 / std::sqrt(42.), 2 / std::sqrt(12.)},
        Lattice{"bcc", 3, 2 / std::sqrt(80. / 3), 2 / std::sqrt(16.), 2 / std::sqrt(56.), 2 / std::sqrt(16.)},
        Lattice{"fcc", 3, 2 / std::sqrt(40.), 2 / std::sqrt(16.), 2 / std::sqrt(84.), 2 / std::sqrt(24.)},
        Lattice{"hcp", 3, 2 / std::sqrt(40.), 2 / std::sqrt(16.), 2 / std::sqrt(84.), 2 / std::sqrt(24.)},
        Lattice{"square", 2, 2 / std::sqrt(16.), 2 / std::sqrt(8.), 2 / std::sqrt(24.), 2 / std::sqrt(8.)},
        Lattice{"hexagonal", 2, 2 / std::sqrt(24.), 2 / std::sqrt(9.), 2 / std::sqrt(36.), 2 / std::sqrt(12.)}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(Case, Demo) {
  const CaseRun run("demo", "--set specimen.count=300");
  ASSERT_TRUE(run.complete());
  EXPECT_NEAR(run["mean_stress_Pa"] / 100e3, 1, 1e-3);
  EXPECT_TRUE(run.result().at("warnings").empty()) << run.result().at("warnings");
  const json j = json::parse(output("timestep --verify --json " + run.file("final.h5")), nullptr, false);
  ASSERT_TRUE(j.is_object());
  // just above the limit motion grows too slowly for the steps that are watched: they tell it to 0.02 %
  // (docs/timestep.md)
  EXPECT_LE(j.at("verification").at("dt_stable").get<double>(), (1 + 2e-4) * j.at("dt_limit_upper").get<double>());
  EXPECT_GE(j.at("verification").at("dt_unstable").get<double>(), j.at("dt_safe").get<double>());
}

TEST(Case, IsotropicCompression) {
  const CaseRun run("isotropic_compression", "--set specimen.count=500");
  ASSERT_TRUE(run.complete());
  EXPECT_NEAR(run["mean_stress_Pa"] / 100e3, 1, 1e-3);
  EXPECT_NEAR(run["void_ratio"], 0.61, 0.04);
  EXPECT_NEAR(run["mechanical_coordination"], 5.3, 0.2);
}

TEST(Case, FrictionlessLimit) {
  const CaseRun run("frictionless_limit", "--set specimen.count=300");
  ASSERT_TRUE(run.complete());
  EXPECT_NEAR(run["solid_fraction"], 0.64, 0.02);  // small periodic cells scatter more than the case itself
  EXPECT_NEAR(run["backbone_coordination"], 6, 0.25);
}

TEST(Case, DisksPeriodic) {
  const CaseRun run("disks_periodic", "--set specimen.count=500 --set stage[2].until.axial_strain=0.02");
  ASSERT_TRUE(run.complete());
  EXPECT_NEAR(run.result().at("stress_Pa").at(0).get<double>() / 100e3, 1, 0.05);
  const auto stage = run.column("stage"), deviator = run.column("deviator"), strain = run.column("strain_y");
  EXPECT_EQ(stage.back(), 2);
  EXPECT_NEAR(strain.back(), 0.02, 1e-4);
  EXPECT_GT(*std::ranges::max_element(deviator), 25e3);
  EXPECT_LT(run["largest_overlap"], 0.05);
}

TEST(Case, SettlingBox) {
  const CaseRun run("settling_box", "--set specimen.count=150");
  ASSERT_TRUE(run.complete());
  EXPECT_LT(std::abs(run.column("energy_residual").back()), 0.01 * run.column("outside_work").back());
  const auto state = eg::read_snapshot(run.file("final.h5")).state;
  double weight = 0, carried = 0;
  for (const auto& v : state.grains.velocity) weight += 9.81 / v.w;
  for (const auto& b : state.bodies) carried -= b.force.z;
  EXPECT_NEAR(carried / weight, 1, 5e-3);  // floor and side walls
}

TEST(Case, TimestepStudy) {
  const json rows =
      json::parse(output("study --json --set specimen.count=150 " + case_file("timestep_study")), nullptr, false);
  ASSERT_TRUE(rows.is_array());
  const auto ratio = [](const json& row, const char* rule) { return row["estimates"][rule]["ratio"].get<double>(); };
  EXPECT_EQ(rows[0]["packing"], "two spheres");
  EXPECT_NEAR(ratio(rows[0], "yade"), 0.8 * std::sqrt(3.0), 1e-9);  // 0.8 √2 √(3 m/k) against √2 √(m/k)
  for (const auto& row : rows) {
    EXPECT_LE(ratio(row, "element"), 1 + 1e-9);
    EXPECT_LE(ratio(row, "gershgorin"), 1 + 1e-9);
    if (row["packing"] != "fcc") continue;  // Δt/T_R = 0.127 (δ/2R)^(−1/4) for ν = 0.12
    const double overlap = row["largest_overlap"];
    EXPECT_NEAR(ratio(row, "rayleigh-rmin") * 0.127 * std::pow(overlap, -0.25), 1, 0.01);
    EXPECT_EQ(row["estimates"]["rayleigh-rmin"]["unstable"].get<bool>(), overlap > 2.6e-4);
  }
}

}  // namespace
