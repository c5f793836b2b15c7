// Trimming a packing to a box or a cylinder.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "io/scene_file.hpp"
#include "measure/volume.hpp"
#include "specimen/make_packing.hpp"
#include "specimen/make_state.hpp"

namespace eg {
namespace {

Scene scene_with(const std::string& trim, const std::string& lattice = "fcc", const std::string& boundary = "free") {
  const bool solid = lattice == "fcc";
  return parse_scene("dimension = " + std::string(solid ? "3" : "2") +
                         "\n[material.m]\ndensity = 1\nfriction = 0.3\nnormal_stiffness = 1\nshear_stiffness = 1\n"
                         "[contact]\nlaw = \"linear\"\n[boundary]\ntype = \"" +
                         boundary + "\"\n[specimen]\nsource = \"lattice\"\nlattice = \"" + lattice +
                         "\"\nradius = 1\ncells = " + (solid ? "[12, 12, 12]" : "[40, 40]") + "\ntrim = " + trim,
                     "a.toml");
}

State state_with(const std::string& trim, const std::string& lattice = "fcc", const std::string& boundary = "free") {
  const Scene scene = scene_with(trim, lattice, boundary);
  return make_state(scene, make_packing(scene));
}

std::string message_of(const std::string& trim, const std::string& boundary = "free") {
  try {
    state_with(trim, "fcc", boundary);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(Trim, ACylinderKeepsWhatLiesInIt) {
  const State whole = state_with("{ cylinder = { centre = [16, 17], radius = 12, from = 4, to = 24 } }");
  const State centres =
      state_with("{ keep = \"centre\", cylinder = { centre = [16, 17], radius = 12, from = 4, to = 24 } }");
  const auto across = [](const Quad& x) { return std::hypot(x.x - 12, x.y - 12); };
  for (const auto& x : whole.grains.position) {
    EXPECT_LE(across(x) + x.w, 12 + 1e-8);
    EXPECT_GE(x.z, 1 - 1e-8);
    EXPECT_LE(x.z, 19 + 1e-8);
  }
  for (const auto& x : centres.grains.position) EXPECT_LE(across(x), 12);
  EXPECT_LT(whole.grains.size(), centres.grains.size());
  EXPECT_EQ(whole.cell.h(0, 0), 24);
  EXPECT_EQ(whole.cell.h(2, 2), 20);
  // grains by centre are as many as their density says
  const double expected = std::numbers::pi * 144 * 20 / (4 * std::numbers::sqrt2);
  EXPECT_NEAR(static_cast<double>(centres.grains.size()) / expected, 1, 0.03);
  EXPECT_EQ(whole.grains.id.back(), whole.grains.size());
}

TEST(Trim, AHollowCylinderAndTheSolidOneWithinItAreTheWhole) {
  const auto size = [](const std::string& radii) {
    return state_with("{ keep = \"centre\", cylinder = { centre = [16, 17], " + radii + " } }").grains.size();
  };
  EXPECT_EQ(size("radius = 12, inner_radius = 5.1") + size("radius = 5.1"), size("radius = 12"));
  const State hollow = state_with("{ cylinder = { centre = [16, 17], radius = 12, inner_radius = 5 } }");
  for (const auto& x : hollow.grains.position) EXPECT_GE(std::hypot(x.x - 12, x.y - 12) - x.w, 5 - 1e-8);
}

TEST(Trim, AQuarterIsCutAroundACornerAndStaysInItsPlace) {
  const State quarter = state_with("{ cylinder = { centre = [0, 0], radius = 25, inner_radius = 4 } }");
  for (const auto& x : quarter.grains.position) {
    EXPECT_GE(std::min(x.x, x.y) - x.w, -1e-8);
    EXPECT_LE(std::hypot(x.x, x.y) + x.w, 25 + 1e-8);
  }
  EXPECT_EQ(quarter.cell.h(0, 0), 25);
  EXPECT_EQ(quarter.cell.h(1, 1), 25);
  const State wide = state_with("{ box = { low = [-9, -9, -9], high = [20, 99, 10] } }");  // no wider than its source
  EXPECT_EQ(wide.cell.h(0, 0), 20);
  EXPECT_NEAR(wide.cell.h(1, 1), 12 * std::numbers::sqrt2 * 2, 2);
}

TEST(Trim, TheAxisMayLieAlongAnyAxis) {
  const auto size = [](const std::string& axis) {
    return state_with("{ cylinder = { axis = \"" + axis + "\", centre = [16, 17], radius = 9.1 } }").grains.size();
  };
  EXPECT_EQ(size("x"), size("z"));  // the lattice is the same along all three
  EXPECT_EQ(size("y"), size("z"));
  const State lying = state_with("{ cylinder = { axis = \"x\", centre = [16, 17], radius = 9.1, from = 5, to = 25 } }");
  EXPECT_EQ(lying.cell.h(0, 0), 20);
  EXPECT_DOUBLE_EQ(lying.cell.h(1, 1), 18.2);
}

TEST(Trim, ABoxFitsIntoItsWalls) {
  const State state = state_with("{ box = { low = [3, 4, 5], high = [13, 24, 20] } }", "fcc", "box");
  ASSERT_EQ(state.walls.size(), 6u);
  EXPECT_EQ(specimen_volume(state), 10 * 20 * 15);
  for (const auto& x : state.grains.position)
    for (const auto& wall : state.walls) EXPECT_GE(dot(x.vec() - wall.point, wall.normal), x.w * (1 - 1e-8));
}

TEST(Trim, SidesThatAreNotCutLieAtTheOutermostGrains) {
  const State state = state_with("{ cylinder = { centre = [16, 17], radius = 9 } }");
  double low = INFINITY, high = -INFINITY;
  for (const auto& x : state.grains.position) low = std::min(low, x.z - x.w), high = std::max(high, x.z + x.w);
  EXPECT_NEAR(low, 0, 1e-12);
  EXPECT_NEAR(high, state.cell.h(2, 2), 1e-12);
}

TEST(Trim, DisksAreCutToCirclesAndRectangles) {
  for (const auto& x : state_with("{ cylinder = { centre = [40, 35], radius = 20 } }", "hexagonal").grains.position)
    EXPECT_LE(std::hypot(x.x - 20, x.y - 20) + x.w, 20 + 1e-8);
  EXPECT_EQ(state_with("{ box = { low = [5, 5], high = [35, 25] } }", "hexagonal").cell.h(1, 1), 20);
}

TEST(Trim, SaysWhatIsWrong) {
  EXPECT_EQ(message_of("{ cylinder = { centre = [16, 17], radius = 0.9 } }"),
            "a.toml: specimen.trim keeps none of the 6912 grains; make it larger, move it, or set keep = \"centre\"");
  EXPECT_EQ(message_of("{ keep = \"centre\", box = { low = [90, 90, 90], high = [91, 91, 91] } }"),
            "a.toml: specimen.trim keeps none of the 6912 grains; make it larger or move it");
  EXPECT_EQ(message_of("{ keep = \"whole\" }").substr(0, 64),
            "a.toml:16: specimen.trim names neither box nor cylinder; write t");
  EXPECT_EQ(message_of("{ box = { low = [1, 1, 1], high = [2, 0, 2] } }"),
            "a.toml:16: specimen.trim.box ends below its beginning; give ascending ends");
  EXPECT_EQ(message_of("{ cylinder = { centre = [1, 1], radius = 1, inner_radius = 1 } }"),
            "a.toml:16: specimen.trim.cylinder.inner_radius = 1 leaves nothing of the cylinder; make it smaller than "
            "radius");
  EXPECT_EQ(message_of("{ box = { low = [1, 1, 1], high = [2, 2, 2] } }", "periodic"),
            "a.toml:16: specimen.trim leaves nothing that is periodic; set boundary.type to \"box\" or \"free\"");
  EXPECT_NE(message_of("{ cylinder = { centre = [1, 1], radius = 1, form = 0 } }").find("did you mean"),
            std::string::npos);
}

}  // namespace
}  // namespace eg
