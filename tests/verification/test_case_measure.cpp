// `eigengrain measure` through the command line: what it prints is what it is documented to mean.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
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

TEST_F(MeasureCommand, ZonesShareOutTheGrains) {
  const json j = measure(test::case_file("lattice_fcc") +
                         " --initial --zones radial:4,sector:3 --zones height:5 --zones x:3,y:0/0.001/0.002");
  ASSERT_EQ(j.at("zones").size(), 3u);
  EXPECT_EQ(j["zones"][0]["table"].size(), 12u);
  EXPECT_EQ(j["zones"][2]["table"].size(), 6u);
  EXPECT_EQ(j["zones"][0]["container"]["shape"], "cylinder");
  for (const auto& zones : j["zones"]) {
    double solid = 0, volume = 0;
    for (const auto& row : zones.at("table"))
      solid += row.at("solid_volume").get<double>(), volume += row.at("volume").get<double>();
    EXPECT_NEAR(solid / zones.at("solid_volume").get<double>(), 1, 1e-13);
    EXPECT_NEAR(volume / zones.at("volume").get<double>(), 1, 1e-13);
    EXPECT_NEAR(zones.at("void_ratio").get<double>(), volume / solid - 1, 1e-12);
  }
  const json layers = measure(test::case_file("settling_box") +
                              " --set specimen.count=50 --initial --zones z:4 --zones height:2 "
                              "--zone-axis x");
  EXPECT_NEAR(layers["zones"][0]["solid_fraction"].get<double>(), layers["specimen"]["solid_fraction"].get<double>(),
              1e-12);
  EXPECT_EQ(layers["zones"][1]["container"]["axis"], "x");
}

TEST_F(MeasureCommand, ASnapshotIsComparedWithAnEarlierOne) {
  const test::CaseRun run(
      "demo", "--set specimen.count=200 --set 'stage[1].record={every_steps=100,snapshot_every_steps=400}'");
  ASSERT_TRUE(run.complete());
  std::string early;  // the first snapshot on the way
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(run.file("final.h5")).parent_path()))
    if (const auto name = entry.path().filename().string();
        name.starts_with("step_") && (early.empty() || name < early))
      early = name;
  ASSERT_FALSE(early.empty());
  const std::string compare = run.file("final.h5") + " --since " + run.file(early.c_str());
  const json j = measure(compare + " --gauge 1e-3,1e-3,1e-3 --sphere 0,0,0,1e-3 --fields " + file("fields.vtp"));
  ASSERT_TRUE(j.is_object());
  EXPECT_EQ(j["since"]["particles"], 200);
  // the cell has become smaller alike in all directions, as the void ratio tells; grains add their own part
  const auto voids = run.column("void_ratio"), steps = run.column("step");
  double before = 0;
  for (std::size_t k = 0; k < steps.size(); ++k)
    if (steps[k] <= std::stod(early.substr(5))) before = voids[k];
  const double expected = 1 - std::cbrt((1 + voids.back()) / (1 + before));
  ASSERT_GT(expected, 1e-3);
  for (const auto* axis : {"strain_x", "strain_y", "strain_z"})
    EXPECT_NEAR(j["since"][axis].get<double>() / expected, 1, 0.3) << axis;
  EXPECT_GT(j["gauge_1"]["displacement"].get<double>(), 0);
  EXPECT_NEAR(j["sphere_1"]["volumetric_strain"].get<double>() / (3 * expected), 1, 0.7);
  EXPECT_LT(j["shear_band"]["explained"].get<double>(), 0.5);
  for (const auto* field : {"displacement", "fluctuation", "strain", "volumetric_strain", "shear_strain", "rotation"})
    EXPECT_NE(read_file(file("fields.vtp")).find("Name=\"" + std::string(field) + "\""), std::string::npos) << field;
  const std::string text = read_file(EIGENGRAIN_SOURCE_DIR "/docs/measures.md");
  for (const auto* section : {"since", "shear_band", "gauge_1"})
    for (const auto& [key, value] : j.at(section).items()) {
      const auto stem = key.substr(0, key.find_last_of('_'));
      EXPECT_TRUE(text.find("`" + key + "`") != std::string::npos || text.find("`" + stem + "_") != std::string::npos)
          << key;
    }
  for (const auto* plot : {"shear-slice", "displacement-slice", "force-slice", "void-slice"}) {
    output("measure " + compare + " --plot " + plot + " --slice z --figure " + file(std::string(plot) + ".svg"));
    EXPECT_GT(std::filesystem::file_size(file(std::string(plot) + ".svg")), 1000u) << plot;
  }
  const std::string disks =
      "measure " + test::case_file("lattice_hexagonal") + " --initial --plot void-slice --figure ";
  output(disks + file("disks.svg"));
  EXPECT_GT(std::filesystem::file_size(file("disks.svg")), 1000u);
  output("measure " + run.file("final.h5") + " --void-map " + file("voids.vti"));
  EXPECT_NE(read_file(file("voids.vti")).find("Name=\"void_ratio\""), std::string::npos);
}

TEST_F(MeasureCommand, HistoriesArePlottedAndAveraged) {
  std::filesystem::create_directories(folder / "a");
  const std::string history = file("a/history.csv");
  write_file(history,
             "step [-],stage [-],strain_z [-],deviator [Pa],mean_stress [Pa]\n"
             "1,1,0.5,7,1\n2,2,0.1,10,100\n3,2,0.2,20,100\n4,2,0.3,40,100\n");
  const std::string command = "plot " + history + " --stage 2 --x strain_z --y deviator/mean_stress --json --figure ";
  const json curve = json::parse(output(command + file("curve.svg")), nullptr, false);
  ASSERT_TRUE(curve.is_array());
  EXPECT_EQ(curve[0]["label"], "a");
  EXPECT_EQ(curve[0]["strain_z [-]"], (std::vector{0.1, 0.2, 0.3}));
  EXPECT_EQ(curve[0]["deviator/mean_stress [-]"], (std::vector{0.1, 0.2, 0.4}));
  const json mean = json::parse(output(command + file("mean.pdf") + " --mean-over strain_z=0.15:1"), nullptr, false);
  ASSERT_TRUE(mean.is_array());
  EXPECT_NEAR(mean[0]["deviator/mean_stress"].get<double>(), 0.3, 1e-15);
  EXPECT_NEAR(mean[0]["deviator/mean_stress_scatter"].get<double>(), 0.1, 1e-15);
  EXPECT_NEAR(mean[0]["strain_z"].get<double>(), 0.25, 1e-15);
  std::filesystem::create_directories(folder / "again/a");
  write_file(file("again/a/history.csv"),
             "step [-],stage [-],strain_z [-],deviator [Pa],mean_stress [Pa]\n"
             "1,2,0.2,60,100\n2,2,0.3,80,100\n");
  const json pooled =
      json::parse(output("plot " + history + " " + file("again/a/history.csv") +
                         " --stage 2 --x strain_z --y deviator/mean_stress --json --pool --mean-over strain_z=0.15:1"),
                  nullptr, false);
  ASSERT_EQ(pooled.size(), 1u);
  EXPECT_NEAR(pooled[0]["deviator/mean_stress"].get<double>(), 0.5, 1e-15);
  EXPECT_NEAR(pooled[0]["deviator/mean_stress_scatter"].get<double>(), std::sqrt(0.05), 1e-15);
  EXPECT_NE(read_file(file("curve.svg")).find("<svg"), std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(file("mean.pdf")));
}

TEST_F(MeasureCommand, MemoryHoldsOnlyWhatTheSceneNeeds) {
  const auto memory = [](const std::string& scene, const std::string& settings) {
    const json j = json::parse(output("info --memory --json " + test::case_file(scene) + settings), nullptr, false);
    std::map<std::string, double> bytes;
    for (const auto& row : j.at("memory")) {
      bytes[row.at("array")] = row.at("bytes");
      EXPECT_NEAR(row.at("bytes_per_particle").get<double>() * 200, row.at("bytes").get<double>(), 1e-6);
    }
    return bytes;
  };
  auto smooth = memory("frictionless_limit", " --set specimen.count=200");
  for (const char* none : {"spin and inertia", "materials", "contact history", "walls", "wall contacts"})
    EXPECT_EQ(smooth.at(none), 0) << none;
  EXPECT_EQ(smooth.at("position and radius"), 200 * 32);
  auto rough = memory("isotropic_compression", " --set specimen.count=200");
  EXPECT_EQ(rough.at("spin and inertia"), 200 * 32);
  EXPECT_EQ(rough.at("walls"), 0);
  EXPECT_GT(rough.at("all"), smooth.at("all"));
}

TEST_F(MeasureCommand, EveryKeyIsDocumented) {
  const std::string text = read_file(EIGENGRAIN_SOURCE_DIR "/docs/measures.md");
  const json j =
      measure(test::case_file("lattice_fcc") + " --initial --sphere 0,0,0,0.004 --zones radial:2 --zones x:2");
  for (const auto& zones : j.at("zones")) {
    for (const auto& [key, value] : zones.items()) EXPECT_NE(text.find("`" + key + "`"), std::string::npos) << key;
    for (const auto& [key, value] : zones.at("table")[0].items())
      EXPECT_NE(text.find("`" + key + "`"), std::string::npos) << key;
  }
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
