// Wave tests in the time domain, through the command line: speeds, ridge and cut-off against the dispersion of the same
// packing, which is a computation of another kind.
#include <gtest/gtest.h>

#include "support/case_run.hpp"

namespace eg {
namespace {

using test::case_file;
using test::json;
using test::output;

json transmit(const std::string& name, const std::string& arguments) {
  return json::parse(output("waves transmit " + case_file(name) + " --json " + arguments), nullptr, false);
}

void expect_speeds(const json& r) {
  ASSERT_TRUE(r.is_object());
  const auto& exact = r.at("dispersion");
  for (const char* key : {"phase_speed_m_per_s", "group_speed_m_per_s"})
    EXPECT_NEAR(r.at(key).get<double>() / exact.at(key).get<double>(), 1, 0.01) << key;
  for (const auto& arrival :
       r.at("arrivals")) {  // readings of the trace itself: within the spread of a dispersive wave
    const double ratio = arrival.at("speed_m_per_s").get<double>() / exact.at("group_speed_m_per_s").get<double>();
    EXPECT_NEAR(ratio, 1, 0.12) << arrival.at("method");
  }
  EXPECT_LT(r.at("ridge").at("mean_error").get<double>(), 0.01);
  EXPECT_EQ(r.at("warnings").size(), 0u) << r.at("warnings");
}

TEST(CaseWaves, LongitudinalAlongTheColumn) {
  const auto r = transmit("waves_fcc_column", "--frequency 30e3 --set specimen.cells=[1,1,150]");
  expect_speeds(r);
  EXPECT_NEAR(r.at("dispersion").at("phase_speed_m_per_s").get<double>(), 734.08, 0.03 * 734);
}

TEST(CaseWaves, TransverseAlongTheColumn) {
  const auto r = transmit("waves_fcc_column", "--frequency 30e3 --motion x --set specimen.cells=[1,1,150]");
  expect_speeds(r);
  EXPECT_NEAR(r.at("dispersion").at("phase_speed_m_per_s").get<double>(), 519.08, 0.03 * 519);
}

TEST(CaseWaves, CutOff) {
  const auto r = transmit("waves_fcc_column", "--frequency 80e3 --signal ricker --set specimen.cells=[1,1,100]");
  ASSERT_TRUE(r.is_object());
  EXPECT_NEAR(r.at("cutoff_Hz").get<double>() / r.at("dispersion").at("highest_Hz").get<double>(), 1, 0.02);
  EXPECT_LT(r.at("ridge").at("mean_error").get<double>(), 0.01);
}

// Its branch ends in pure rotation at the edge of the zone, where another branch, above a gap, takes the translation
// over.
TEST(CaseWaves, CutOffOfTransverseWaves) {
  const auto r =
      transmit("waves_fcc_column", "--frequency 60e3 --signal ricker --motion x --set specimen.cells=[1,1,100]");
  ASSERT_TRUE(r.is_object());
  const auto bands = json::parse(output("waves dispersion " + case_file("waves_fcc_column") +
                                        " --json --path \"G X\" --points 2 --set specimen.cells=[2,2,2]"));
  const double top = bands.at("points").at(2).at("frequency_Hz").at(0).get<double>();
  EXPECT_NEAR(r.at("dispersion").at("highest_Hz").get<double>() / top, 1, 1e-4);  // the branch is drawn in 400 points
  EXPECT_NEAR(r.at("cutoff_Hz").get<double>() / top, 1, 0.02);
}

TEST(CaseWaves, CutOffOfOtherLattices) {
  for (const char* lattice : {"bcc", "fcc-111"}) {
    const auto r =
        transmit("waves_fcc_column", "--frequency 80e3 --signal ricker --set specimen.cells=[2,2,80] --set " +
                                         ("specimen.lattice='\"" + std::string(lattice) + "\"'"));
    ASSERT_TRUE(r.is_object()) << lattice;
    EXPECT_NEAR(r.at("cutoff_Hz").get<double>() / r.at("dispersion").at("highest_Hz").get<double>(), 1, 0.02);
  }
}

TEST(CaseWaves, SaysWhenTheSignalHasNotPassed) {
  const auto r = transmit("waves_fcc_column", "--frequency 30e3 --signal ricker --set specimen.cells=[1,1,60]");
  ASSERT_TRUE(r.is_object());
  bool said = false;
  for (const auto& warning : r.at("warnings"))
    said |= warning.get<std::string>().find("has passed") != std::string::npos;
  EXPECT_TRUE(said) << r.at("warnings");
}

TEST(CaseWaves, SizeOfTheSourceReduced) {
  expect_speeds(transmit("waves_fcc_81576", "--frequency 30e3 --motion x --set specimen.cells=[1,2,103]"));
}

TEST(CaseWaves, DispersionOfTheColumn) {
  const auto r =
      json::parse(output("waves dispersion " + case_file("waves_fcc_column") + " --json --set specimen.cells=[2,2,2]"));
  EXPECT_EQ(r.at("unit_cell").at("particles"), 1);
  const auto speeds = r.at("long_waves").at(0).at("speeds_m_per_s");
  EXPECT_NEAR(speeds.at(2).get<double>(), 734.08, 1e-3 * 734);
  EXPECT_NEAR(speeds.at(0).get<double>(), 519.08, 1e-3 * 519);
  for (const auto& wave : r.at("long_waves"))
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(wave.at("elastic_speeds_m_per_s").at(k).get<double>() / wave.at("speeds_m_per_s").at(k).get<double>(),
                  1, 1e-6);
}

TEST(CaseWaves, RandomPacking) {
  const test::CaseRun packing("waves_random", "--set specimen.count=1200");
  ASSERT_TRUE(packing.complete());
  const std::string command = "waves transmit " + packing.file("final.h5") + " --json --frequency 20e3 ";
  const auto layer = json::parse(output(command));
  EXPECT_TRUE(layer.at("subtracted").get<bool>());
  for (const auto& arrival : layer.at("arrivals"))
    if (arrival.at("method") == "cross-correlation") {
      EXPECT_GT(arrival.at("speed_m_per_s").get<double>(), 300);
      EXPECT_LT(arrival.at("speed_m_per_s").get<double>(), 734);  // of the crystal
    }
  const auto point = json::parse(output(command + "--motion x --point 0.004 0.004 0.01"));
  EXPECT_FALSE(point.contains("ridge"));
}

TEST(CaseWaves, ModesOfACase) {
  const auto r = json::parse(output("waves modes " + case_file("lattice_fcc") + " --highest 3 --states dense --json"));
  EXPECT_NEAR(r.at("modes").at(2).at("frequency").get<double>(), 302122.4, 0.1);
  EXPECT_NEAR(r.at("density").at("total").get<double>(), 648, 1e-9);
  EXPECT_TRUE(r.at("complete").get<bool>());
}

}  // namespace
}  // namespace eg
