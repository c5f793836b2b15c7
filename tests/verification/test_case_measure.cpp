// `eigengrain measure` through the command line: what it prints is what it is documented to mean.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "io/text_file.hpp"
#include "support/case_run.hpp"

namespace eg {
namespace {

using nlohmann::json;
using test::output;

json measure(const std::string& arguments) {
  return json::parse(output("measure --json " + arguments), nullptr, false);
}

class MeasureCommand : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove_all(folder); }
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("eigengrain_measure_" + std::to_string(getpid()));
  std::string file(const std::string& name) const { return (folder / name).string(); }
};

TEST_F(MeasureCommand, LatticesHaveTheirKnownStructure) {
  struct Known {
    const char* name;
    int contacts;
    double solid;
  };
  const double pi = std::numbers::pi;
  for (const auto& [name, contacts, solid] :
       {Known{"sc", 6, pi / 6}, Known{"fcc", 12, pi / std::sqrt(18)}, Known{"hexagonal", 6, pi / std::sqrt(12)}}) {
    const json j = measure(test::case_file(std::string("lattice_") + name) + " --initial --sphere 0,0" +
                           (std::string(name) == "hexagonal" ? "" : ",0") + ",0.004");
    ASSERT_TRUE(j.is_object()) << name;
    const double dimension = j.at("dimension");
    EXPECT_EQ(j["coordination"]["coordination"], contacts) << name;
    EXPECT_EQ(j["coordination"]["rattler_share"], 0);
    EXPECT_NEAR(j["specimen"]["solid_fraction"].get<double>() / solid, 1, 1e-3) << name;  // touching by tiny overlaps
    EXPECT_NEAR(j["fabric"]["fabric_1"].get<double>(), 1 / dimension, 1e-9) << name;
    EXPECT_NEAR(j["fabric"]["fabric_deviator"].get<double>(), 0, 1e-9) << name;
    EXPECT_EQ(j["connectivity"].back().get<double>(), j["specimen"]["particles"].get<double>());
    EXPECT_EQ(j["sphere_1"]["coordination"], contacts) << name;
    EXPECT_TRUE(j["warnings"].empty());
  }
}

TEST_F(MeasureCommand, ASnapshotGivesTheLastRowOfItsHistory) {
  const test::CaseRun run("demo", "--set specimen.count=200");
  ASSERT_TRUE(run.complete());
  const json j = measure(run.file("final.h5") + " --figure " + file("rose.svg") + " --chains " + file("chains.vtp"));
  ASSERT_TRUE(j.is_object());
  const std::pair<const char*, std::vector<const char*>> sections[] = {
      {"stress", {"stress_x", "stress_z", "stress_xy", "mean_stress", "deviator", "normal_deviator_share"}},
      {"specimen", {"void_ratio"}},
      {"coordination", {"coordination", "mechanical_coordination", "rattler_share"}},
      {"fabric", {"fabric_1", "fabric_3", "fabric_deviator", "force_fabric_deviator"}},
      {"contacts", {"sliding_fraction", "largest_overlap", "mean_contact_force", "strong_contact_share"}},
      {"motion", {"inertial_number"}}};
  for (const auto& [section, keys] : sections)
    for (const auto* key : keys) {
      const double measured = j.at(section).at(key), recorded = run.column(key).back();
      const bool stress = std::string(section) == "stress" && std::string(key) != "normal_deviator_share";
      const double scale = stress ? 1e5 : std::abs(recorded);  // the history takes the last force loop's sums
      EXPECT_NEAR(measured, recorded, 1e-5 * scale) << key;
      EXPECT_TRUE(j.at("units").at(section).contains(key));
    }
  double share = 0, solids = 0;
  for (const auto& f : j.at("size_fractions"))
    share += f["mean_stress_share"].get<double>(), solids += f["solid_share"].get<double>();
  EXPECT_NEAR(share, 1, 1e-9);
  EXPECT_NEAR(solids, 1, 1e-9);
  EXPECT_NE(read_file(file("rose.svg")).find("<svg"), std::string::npos);
  EXPECT_NE(read_file(file("chains.vtp")).find("Name=\"chain\""), std::string::npos);
  EXPECT_EQ(measure(run.file("final.h5") + " --split 0.2e-3").at("size_fractions").size(), 2u);
  for (const auto* plot : {"force-rose", "connectivity", "forces", "spins", "fractions"}) {
    output("measure " + run.file("final.h5") + " --plot " + plot + " --figure " + file(std::string(plot) + ".pdf"));
    EXPECT_GT(std::filesystem::file_size(file(std::string(plot) + ".pdf")), 1000u) << plot;
  }
}

TEST_F(MeasureCommand, EveryKeyIsDocumented) {
  const std::string text = read_file(EIGENGRAIN_SOURCE_DIR "/docs/measures.md");
  const json j = measure(test::case_file("lattice_fcc") + " --initial --sphere 0,0,0,0.004");
  for (const auto& [section, rows] : j.at("units").items())
    for (const auto& [key, unit] : rows.items()) {
      const auto stem = key.substr(0, key.find_last_of('_'));  // components are written `stress_x` … `stress_xy`
      const bool named =
          text.find("`" + key + "`") != std::string::npos || text.find("`" + stem + "_") != std::string::npos;
      EXPECT_TRUE(named || section == "energy") << section << "." << key;
    }
}

}  // namespace
}  // namespace eg
