// What `--zones` and `--container` understand, and the line that answers when they do not.
#include <gtest/gtest.h>

#include "app/zone_report.hpp"
#include "base/error.hpp"

namespace eg {
namespace {

State two_grains(int dimension) {
  State state;
  state.dimension = dimension;
  state.grains.position = {{0, 0, 0, 1}, {2, 0, 0, 1}};
  state.grains.velocity.resize(2);
  return state;
}

std::string message_of(const ZoneFlags& flags, int dimension = 3) {
  try {
    zone_reports(two_grains(dimension), flags, "a.h5");
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(ZoneReport, CutsWhatItIsTold) {
  ZoneFlags flags{{"radial:2,height:0/0.5/0.75/1"}, "cylinder:1,0,3,-1,2", "x"};
  const auto reports = zone_reports(two_grains(3), flags, "a.h5");
  const auto& grid = reports.at(0).grid;
  EXPECT_EQ(grid.edges[0], (std::vector{0.0, 1.5, 3.0}));
  EXPECT_EQ(grid.edges[2], (std::vector{0.0, 0.5, 0.75, 1.0}));
  EXPECT_EQ(grid.centre.y, 1);
  EXPECT_EQ(grid.centre.z, 0);
  EXPECT_EQ(json_of(reports[0], 3)["table"].size(), 6u);
  const auto flat = zone_reports(two_grains(2), {{"x:2"}, "box:-1,3,-1,1", "z"}, "a.h5");
  EXPECT_NEAR(flat[0].table.whole.void_ratio(), 8 / (2 * 3.141592653589793) - 1, 1e-12);
}

TEST(ZoneReport, SaysWhatIsWrong) {
  const std::string remedy =
      "; name coordinates and counts: radial:9 or height:5 or radial:4,sector:8,height:3 (cylinder), x:4,z:3 (box)";
  EXPECT_EQ(message_of({{"rings:3"}, "", "z"}), "a.h5: --zones rings:3 makes no zones of a cylinder" + remedy);
  EXPECT_EQ(message_of({{"x:2,height:3"}, "", "z"}), "a.h5: --zones x:2,height:3 makes no zones of a box" + remedy);
  EXPECT_EQ(message_of({{"x:2,x:3"}, "", "z"}), "a.h5: --zones x:2,x:3 cuts x twice" + remedy);
  EXPECT_EQ(message_of({{"x"}, "", "z"}), "a.h5: --zones x makes no zones of a box" + remedy);
  EXPECT_EQ(message_of({{"x:0"}, "", "z"}),
            "a.h5: --zones x:0 asks for 0 parts; give a whole number of 1 or more, or places 0/0.01/0.02");
  EXPECT_EQ(message_of({{"x:a"}, "", "z"}),
            "a.h5: --zones x:a has \"a\" where a number belongs; write numbers in m without a unit");
  EXPECT_EQ(message_of({{"x:1/1"}, "", "z"}),
            "a.h5: --zones x:1/1 has places that do not ascend; write them from low to high: 0/0.01/0.02");
  EXPECT_EQ(
      message_of({{"radial:-1/1"}, "", "z"}),
      "a.h5: --zones radial:-1/1 leaves the cylinder; radii are 0 or more and sectors [rad] make one turn at most");
  EXPECT_EQ(message_of({{"radial:2"}, "box:1,2,3", "z"}),
            "a.h5: --container box:1,2,3 is not the cylinder that --zones cuts; write cylinder:X,Y,R,BOTTOM,TOP");
  EXPECT_EQ(message_of({{"radial:2"}, "cylinder:1,2,3", "z"}),
            "a.h5: --container cylinder:1,2,3 has the wrong number of numbers; write cylinder:X,Y,R,BOTTOM,TOP");
  EXPECT_EQ(message_of({{"radial:2"}, "cylinder:0,0,0,0,1", "z"}),
            "a.h5: --container cylinder:0,0,0,0,1 has a radius that is not above 0; write cylinder:X,Y,R,BOTTOM,TOP");
  EXPECT_EQ(
      message_of({{"x:2"}, "box:0,1,1,0,0,1", "z"}),
      "a.h5: --container box:0,1,1,0,0,1 has an end that is not above its beginning; give FROM,TO in ascending order");
  EXPECT_EQ(message_of({{}, "box:0,1,0,1,0,1", "z"}), "a.h5: --container is read with --zones only" + remedy);
  EXPECT_EQ(message_of({{"radial:2"}, "", "x"}, 2), "a.h5: --zone-axis is for 3D; leave it out");
  EXPECT_EQ(message_of({{"radial:2,height:2"}, "", "z"}, 2),
            "a.h5: --zones radial:2,height:2 makes no zones of a cylinder" + remedy);
}

}  // namespace
}  // namespace eg
