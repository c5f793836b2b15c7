// Good scenes: what is written is what is read, and what may be left out has the stated default.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "io/scene_file.hpp"

namespace {

using Kind = eg::ComponentControl::Kind;

const char* triaxial = R"(title = "triaxial"
dimension = 3
seed = 7

[material.quartz]
shear_modulus = 29e9
poisson = 0.12
density = 2650
friction = 0.25

[material.apple]        # after quartz in the file, before it in the alphabet
shear_modulus = 1e9
poisson = 0.3
density = 1000
friction = 0

[contact]
law = "hertz-mindlin-rescale"
arms = "radius"

[specimen]
source = "cloud"
count = 10624
grading = "toyoura"
aspect = [1, 1, 2]

[boundary]
type = "periodic"

[damping]
local = 0.1
normal_ratio = 0.05

[timestep]
policy = "certified"
safety = 0.8

[record]
energy = true

[[stage]]
name = "compress"
friction = 0.1
stress = { isotropic = 100e3, xy = -5e3 }
until = { stress_error = 1e-3, unbalanced_force = 1e-5 }

[[stage]]
name = "shear"
strain_rate = { z = 1e-2, yz = -2e-3 }
hold = { mean_stress = 100e3, equal = ["x", "y"] }
max_strain_rate = 5
until = { axial_strain = 0.5, steps = 1e6 }
record = { every_strain = 1e-3, snapshot_every_steps = 20000 }
)";

std::string triaxial_without_title() { return std::string(triaxial).substr(std::string(triaxial).find('\n') + 1); }

TEST(SceneFile, ReadsAFullScene) {
  const auto scene = eg::parse_scene(triaxial, "dir/triaxial.toml");
  EXPECT_EQ(scene.title, "triaxial");
  EXPECT_EQ(scene.text, triaxial);
  EXPECT_EQ(eg::resolve_path(scene, "grains.txt"), "dir/grains.txt");
  EXPECT_EQ(eg::resolve_path(scene, "/grains.txt"), "/grains.txt");
  EXPECT_EQ(scene.dimension, 3);
  EXPECT_EQ(scene.seed, 7u);
  EXPECT_EQ(norm(scene.gravity), 0);
  ASSERT_EQ(scene.materials.size(), 2u);
  EXPECT_EQ(scene.materials[0].name, "quartz");
  EXPECT_EQ(scene.materials[0].shear_modulus, 29e9);
  EXPECT_EQ(scene.materials[0].density, 2650);
  EXPECT_TRUE(std::isnan(scene.materials[0].normal_stiffness));
  EXPECT_EQ(scene.materials[1].name, "apple");
  EXPECT_EQ(scene.contact.law, "hertz-mindlin-rescale");
  EXPECT_EQ(scene.contact.arms, "radius");
  EXPECT_EQ(scene.specimen.source, eg::SpecimenSpec::Source::cloud);
  EXPECT_EQ(scene.specimen.count, 10624u);
  EXPECT_EQ(scene.specimen.aspect[2], 2);
  ASSERT_EQ(scene.specimen.grading.kind, eg::Grading::Kind::table);
  EXPECT_EQ(scene.specimen.grading.passing.back()[0], 0.425e-3);
  EXPECT_EQ(scene.damping.local, 0.1);
  EXPECT_EQ(scene.damping.normal_ratio, 0.05);
  EXPECT_EQ(scene.timestep.safety, 0.8);
  EXPECT_TRUE(scene.energy);
}

TEST(SceneFile, ReadsStages) {
  const auto stages = eg::parse_scene(triaxial).stages;
  ASSERT_EQ(stages.size(), 2u);

  const auto& compress = stages[0];
  EXPECT_EQ(compress.friction, 0.1);
  EXPECT_FALSE(compress.local_damping);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(compress.control[k].kind, Kind::stress);
    EXPECT_EQ(compress.control[k].value, 100e3);
  }
  EXPECT_EQ(compress.control[3].kind, Kind::rate);  // not named: rate 0
  EXPECT_EQ(compress.control[3].value, 0);
  EXPECT_EQ(compress.control[5].kind, Kind::stress);
  EXPECT_EQ(compress.control[5].value, -5e3);
  EXPECT_EQ(compress.until_stress_error, 1e-3);
  EXPECT_EQ(compress.until_unbalanced, 1e-5);
  EXPECT_TRUE(std::isnan(compress.until_time));

  const auto& shear = stages[1];
  EXPECT_EQ(shear.control[2].kind, Kind::rate);
  EXPECT_EQ(shear.control[2].value, 1e-2);
  EXPECT_EQ(shear.control[3].value, -2e-3);
  EXPECT_EQ(shear.control[0].kind, Kind::free);
  EXPECT_EQ(shear.control[1].kind, Kind::free);
  ASSERT_EQ(shear.hold.size(), 2u);
  EXPECT_EQ(shear.hold[0].value, 100e3);
  EXPECT_EQ(shear.hold[0].coefficient[2], 1. / 3);
  EXPECT_EQ(shear.hold[1].coefficient, (std::array<double, 6>{1, -1, 0, 0, 0, 0}));
  EXPECT_EQ(shear.max_strain_rate, 5);
  EXPECT_EQ(shear.until_axial_strain, 0.5);
  EXPECT_EQ(shear.until_steps, 1e6);
  EXPECT_EQ(shear.record_every_strain, 1e-3);
  EXPECT_EQ(shear.snapshot_every_steps, 20000);
}

TEST(SceneFile, ReadsAPlaneLatticeInABoxWithAWall) {
  const auto scene = eg::parse_scene(R"(dimension = 2
rotation = false
gravity = [0, -9.81]
material.steel = { density = 7850, friction = 0.2, effective_modulus = 145e6, stiffness_ratio = 1.75 }
contact.law = "linear"
specimen = { source = "lattice", lattice = "hexagonal", cells = [5, 6], radius = 3e-3, pressure = 50e3 }
[boundary]
type = "box"
[[boundary.wall]]
name = "ramp"
point = [0, 1]
normal = [3, 4]
[timestep]
policy = "fixed"
fixed = 1e-6
)");
  EXPECT_EQ(scene.dimension, 2);
  EXPECT_FALSE(scene.rotation);
  EXPECT_EQ(scene.gravity.y, -9.81);
  EXPECT_EQ(scene.materials[0].stiffness_ratio, 1.75);
  EXPECT_EQ(scene.specimen.cells, (std::array{5, 6, 1}));
  EXPECT_EQ(scene.specimen.pressure, 50e3);
  EXPECT_EQ(scene.boundary.wall_material, "steel");
  ASSERT_EQ(scene.boundary.walls.size(), 1u);
  EXPECT_EQ(scene.boundary.walls[0].material, "steel");
  EXPECT_NEAR(scene.boundary.walls[0].normal.y, 0.8, 1e-15);
  EXPECT_EQ(scene.timestep.fixed, 1e-6);
  EXPECT_TRUE(scene.stages.empty());
}

eg::Grading grading(const std::string& text) {
  return eg::parse_scene(R"(dimension = 3
material.a = { density = 1, friction = 0, normal_stiffness = 1, shear_stiffness = 0 }
contact.law = "linear"
boundary.type = "periodic"
timestep.policy = "estimate:rayleigh"
[specimen]
source = "cloud"
count = 10
grading = )" + text)
      .specimen.grading;
}

TEST(SceneFile, ReadsEveryKindOfGrading) {
  using enum eg::Grading::Kind;
  const auto one = grading("{ radius = 1e-3 }");
  EXPECT_EQ(one.kind, single);
  EXPECT_EQ(one.min_radius, 1e-3);
  EXPECT_EQ(one.max_radius, 1e-3);
  const auto range = grading("{ min_radius = 1e-3, max_radius = 2e-3 }");
  EXPECT_EQ(range.kind, uniform);
  EXPECT_EQ(range.max_radius, 2e-3);
  const auto curve = grading("{ passing = [[1e-3, 0], [2e-3, 0.4], [4e-3, 1]] }");
  EXPECT_EQ(curve.kind, table);
  EXPECT_EQ(curve.passing[1], (std::array{2e-3, 0.4}));
  EXPECT_EQ(curve.max_radius, 2e-3);
  const auto gap = grading("{ coarse = [2e-3, 4e-3], fines = [0.5e-3, 1e-3], fines_content = 0.3 }");
  EXPECT_TRUE(gap.gap);
  EXPECT_EQ(gap.passing, (std::vector<std::array<double, 2>>{{0.5e-3, 0}, {1e-3, 0.3}, {2e-3, 0.3}, {4e-3, 1}}));
}

TEST(SceneFile, ScalesEveryKindOfGrading) {
  EXPECT_EQ(grading("{ radius = 1e-3 }\nscale = 4").min_radius, 4e-3);
  EXPECT_EQ(grading("{ min_radius = 1e-3, max_radius = 2e-3 }\nscale = 4").max_radius, 8e-3);
  const auto sand = grading("\"toyoura\""), coarser = grading("\"toyoura\"\nscale = 4");
  for (std::size_t k = 0; k < sand.passing.size(); ++k) {
    EXPECT_EQ(coarser.passing[k][0], 4 * sand.passing[k][0]);
    EXPECT_EQ(coarser.passing[k][1], sand.passing[k][1]);
  }
  EXPECT_EQ(coarser.max_radius, 4 * sand.max_radius);
}

TEST(SceneFile, TextsAndCommentsMayHoldAnyLetter) {
  const std::string start =
      "\xEF\xBB\xBFtitle = \"\"\"\u00b5 \\\" # \\\n \u00a7\U0001F30D\"\"\"\"  # \u03b5 'quotes\" in comments\n";
  const auto scene = eg::parse_scene(start + triaxial_without_title());
  EXPECT_EQ(scene.title, "\u00b5 \" # \u00a7\U0001F30D\"");
  EXPECT_TRUE(scene.text.starts_with(start));
}

TEST(SceneFile, SettingsReplaceAddAndStayWithTheText) {
  const auto scene = eg::parse_scene(
      triaxial, "a.toml",
      {"specimen.count = 300", "specimen.aspect[3]=3", "contact.law=hertz-mindlin", "stage[1].until = { steps = 5 }",
       "stage[1].record.every_steps=2", "title=\"\u00b5 = 'x'\"", "material.coal={density=1, friction=0}",
       "material.coal.shear_modulus=1e9", "material.coal.poisson=0.1"});
  const auto again = eg::parse_scene(scene.text, "b.toml");
  for (const auto& s : {scene, again}) {
    EXPECT_EQ(s.specimen.count, 300u);
    EXPECT_EQ(s.specimen.aspect[2], 3);
    EXPECT_EQ(s.contact.law, "hertz-mindlin");
    EXPECT_EQ(s.stages[0].until_steps, 5);
    EXPECT_TRUE(std::isnan(s.stages[0].until_stress_error));
    EXPECT_EQ(s.stages[0].record_every_steps, 2);
    EXPECT_EQ(s.title, "\u00b5 = 'x'");
    ASSERT_EQ(s.materials.size(), 3u);
    EXPECT_EQ(s.materials[0].name, "quartz");  // what a setting adds comes last
    EXPECT_EQ(s.materials[2].name, "coal");
    EXPECT_EQ(s.seed, 7u);
  }
  EXPECT_EQ(scene.text, again.text);
  EXPECT_TRUE(scene.text.ends_with(triaxial));
}

TEST(SceneFile, ReadsEveryCaseOfTheProject) {
  int cases = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(EIGENGRAIN_SOURCE_DIR "/cases"))
    if (entry.path().extension() == ".toml") {
      ++cases;
      EXPECT_NO_THROW(eg::read_scene(entry.path().string())) << entry.path();
    }
  EXPECT_GT(cases, 0);
}

}  // namespace
