#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "specimen/make_packing.hpp"
#include "specimen/make_state.hpp"

using namespace eg;

namespace {

constexpr double pi = std::numbers::pi;

Scene quartz_fcc() {
  Scene scene;
  scene.file = "test.toml";
  Material quartz;
  quartz.name = "quartz", quartz.density = 2650, quartz.friction = 0.25;
  quartz.shear_modulus = 29e9, quartz.poisson = 0.12;
  Material steel = quartz;
  steel.name = "steel", steel.friction = 0.1;
  scene.materials = {quartz, steel};
  scene.specimen.source = SpecimenSpec::Source::lattice;
  scene.specimen.lattice = "fcc";
  scene.specimen.cells = {2, 3, 4};
  scene.specimen.radius = 1e-3;
  return scene;
}

Scene disks(std::size_t count) {
  Scene scene = quartz_fcc();
  scene.dimension = 2;
  scene.specimen.source = SpecimenSpec::Source::cloud;
  scene.specimen.count = count;
  scene.specimen.grading.kind = Grading::Kind::uniform;
  scene.specimen.grading.min_radius = 1e-3, scene.specimen.grading.max_radius = 2e-3;
  return scene;
}

State state_of(const Scene& scene) { return make_state(scene, make_packing(scene)); }

std::string error_of(const Scene& scene, const Packing& packing) {
  try {
    make_state(scene, packing);
  } catch (const InputError& e) {
    return e.what();
  }
  return {};
}

std::string error_of(const Scene& scene) {
  try {
    state_of(scene);
  } catch (const InputError& e) {
    return e.what();
  }
  return {};
}

}  // namespace

TEST(MakeState, PeriodicSpheres) {
  const Scene scene = quartz_fcc();
  const State state = state_of(scene);
  ASSERT_EQ(state.grains.size(), 4u * 24);
  EXPECT_EQ(state.dimension, 3);
  EXPECT_EQ(state.cell.periodic, (std::array{true, true, true}));
  EXPECT_NEAR(state.cell.h(1, 1), 3 * std::sqrt(2.0) * 2e-3, 1e-15);
  const double mass = 2650 * 4 * pi / 3 * 1e-9;
  for (std::size_t i = 0; i < state.grains.size(); ++i) {
    EXPECT_EQ(state.grains.id[i], i + 1);
    EXPECT_EQ(state.grains.radius(i), 1e-3);
    EXPECT_NEAR(state.grains.velocity[i].w * mass, 1, 1e-14);
    EXPECT_NEAR(state.grains.spin[i].w * 0.4 * mass * 1e-6, 1, 1e-14);
    EXPECT_EQ(norm(state.grains.velocity[i].vec()), 0);
  }
  EXPECT_EQ(state.friction, (std::vector{0.25, 0.1, 0.1, 0.1}));
  EXPECT_TRUE(state.walls.empty());
  EXPECT_EQ(state.contacts.size(), 0u);
}

TEST(MakeState, DisksHaveUnitThickness) {
  const Scene scene = disks(50);
  const State state = state_of(scene);
  EXPECT_EQ(state.cell.periodic, (std::array{true, true, false}));
  EXPECT_EQ(state.cell.h(2, 2), 1);
  double area = 0;
  for (std::size_t i = 0; i < state.grains.size(); ++i) {
    const double r = state.grains.radius(i);
    area += pi * r * r;
    EXPECT_NEAR(state.grains.velocity[i].w * 2650 * pi * r * r, 1, 1e-14);
    EXPECT_NEAR(state.grains.spin[i].w * 0.5 * 2650 * pi * r * r * r * r, 1, 1e-14);
  }
  EXPECT_NEAR(area / state.cell.volume(), scene.specimen.solid_fraction, 1e-12);
}

TEST(MakeState, NoRotationNoSpin) {
  Scene scene = quartz_fcc();
  scene.rotation = false;
  EXPECT_FALSE(state_of(scene).grains.rotates());
}

TEST(MakeState, BoxBecomesWalls) {
  for (const int dimension : {2, 3}) {
    Scene scene = dimension == 3 ? quartz_fcc() : disks(40);
    scene.boundary.kind = BoundarySpec::Kind::box;
    scene.boundary.wall_material = "steel";
    WallSpec lid;
    lid.point = {0, dimension == 3 ? 0.5 : 1.0, 0}, lid.normal = {0, -2, 0}, lid.material = "quartz";
    scene.boundary.bodies = box_bodies(dimension);
    lid.body = scene.boundary.bodies.size();
    scene.boundary.bodies.push_back({.name = "lid", .group = "", .velocity = {0, -0.1, 0}, .material = ""});
    scene.boundary.walls = {lid};
    const State state = state_of(scene);
    EXPECT_FALSE(state.cell.any_periodic());
    ASSERT_EQ(state.walls.size(), 2u * static_cast<std::size_t>(dimension) + 1);
    for (std::size_t w = 0; w + 1 < state.walls.size(); ++w) {
      EXPECT_EQ(state.walls[w].material, 1);
      EXPECT_EQ(norm(state.walls[w].normal), 1);
      for (std::size_t i = 0; i < state.grains.size(); ++i)  // every grain lies wholly on the inner side
        EXPECT_GE(dot(state.grains.position[i].vec() - state.walls[w].point, state.walls[w].normal),
                  state.grains.radius(i) * (1 - 1e-12));
    }
    EXPECT_EQ(state.walls.back().material, 0);
    EXPECT_EQ(state.walls.back().normal.y, -1);
    EXPECT_EQ(state.bodies.size(), scene.boundary.bodies.size());
  }
}

TEST(MakeState, PressureOfTheSceneSetsTheOverlap) {  // Hertz: N = √2 p R² on FCC at small overlap
  Scene scene = quartz_fcc();
  scene.specimen.pressure = 100e3;
  const State state = state_of(scene);
  const double distance = state.cell.h(0, 0) / (2 * std::sqrt(2.0)), overlap = 2e-3 - distance;
  const double e_star = 29e9 / (1 - 0.12);
  const double force = 4. / 3 * e_star * std::sqrt(5e-4) * std::pow(overlap, 1.5);
  EXPECT_NEAR(force * 2 * std::sqrt(2.0) / (distance * distance) / 100e3, 1, 1e-9);
}

TEST(MakeState, CentresAreWrappedIntoThePeriodicCell) {
  Scene scene = quartz_fcc();
  Packing packing;
  packing.box = {1, 2, 3};
  packing.position = {{1.25, -0.5, 3}, {-1e-20, 2, -6.5}};
  packing.radius = {0.1, 0.2};
  const State state = make_state(scene, packing);
  EXPECT_EQ(state.grains.position[0].x, 0.25);
  EXPECT_EQ(state.grains.position[0].y, 1.5);
  EXPECT_EQ(state.grains.position[0].z, 0);
  EXPECT_EQ(state.grains.position[1].x, 0);
  EXPECT_EQ(state.grains.position[1].y, 0);
  EXPECT_EQ(state.grains.position[1].z, 2.5);
  scene.boundary.kind = BoundarySpec::Kind::free;
  EXPECT_EQ(make_state(scene, packing).grains.position[0].x, 1.25);
}

TEST(MakeState, SameSeedSameState) {
  Scene scene = disks(100);
  const auto first = state_of(scene), second = state_of(scene);
  scene.seed = 2;
  const auto third = state_of(scene);
  for (std::size_t i = 0; i < 100; ++i) EXPECT_EQ(first.grains.position[i].x, second.grains.position[i].x);
  EXPECT_NE(first.grains.position[3].x, third.grains.position[3].x);
}

TEST(MakeState, ErrorsNameTheRule) {
  Packing packing;
  packing.box = {1, 1, 1};
  packing.position = {{.5, .5, .5}};
  packing.radius = {0.1};
  const Scene good = quartz_fcc();
  EXPECT_EQ(error_of(good, packing), "");
  EXPECT_EQ(error_of(good, Packing{}), "test.toml: specimen has no grains");

  Scene scene = good;
  scene.dimension = 2;
  EXPECT_EQ(error_of(scene, packing), "test.toml: dimension = 2 but the packing has 3");
  EXPECT_EQ(error_of(scene),
            "test.toml: specimen.lattice = \"fcc\" is not a lattice in 2 dimensions; "
            "take square or hexagonal");
  scene = good;
  scene.materials[0].density = Material::unset;
  EXPECT_NE(error_of(scene, packing).find("density"), std::string::npos);

  scene = good;
  Packing wide = packing;
  wide.radius[0] = 0.6;
  EXPECT_EQ(error_of(scene, wide),
            "test.toml: box edge x = 1 m is narrower than the largest grain, 1.2 m; take more grains or a larger box");
  wide.radius[0] = 0;
  EXPECT_NE(error_of(scene, wide).find("radius 0 m"), std::string::npos);

  scene.boundary.bodies = box_bodies(scene.dimension);
  scene.boundary.kind = BoundarySpec::Kind::box;
  scene.boundary.wall_material = "stel";
  EXPECT_EQ(error_of(scene, packing),
            "test.toml: wall material \"stel\" is not a material of the scene; add [material.stel]");
  scene.boundary.wall_material = "steel";
  packing.position[0].z = -0.25;
  EXPECT_NE(error_of(scene, packing).find("grain 1 has z = -0.25 m, outside the box [0, 1]"), std::string::npos);

  scene = good;
  scene.specimen.overlap = 0.11;
  EXPECT_EQ(error_of(scene), "test.toml: specimen.overlap = 0.11 must not be more than 0.1 of the diameter");
  scene = good;
  scene.specimen.pressure = 1e12;
  EXPECT_NE(error_of(scene).find("specimen.pressure = 1e+12 needs overlaps of more than 0.1"), std::string::npos);
  scene.specimen.pressure = 1e5;
  scene.specimen.radius_scatter = 0.1;
  EXPECT_NE(error_of(scene).find("radius_scatter"), std::string::npos);
  EXPECT_NE(error_of([] {
              auto s = disks(0);
              return s;
            }())
                .find("specimen.count = 0"),
            std::string::npos);
}

TEST(MakeState, GrainsThatNothingCanTurnHaveNoSpin) {
  Scene scene = quartz_fcc();
  EXPECT_TRUE(state_of(scene).grains.rotates());
  for (auto& m : scene.materials) m.friction = 0;
  State smooth = state_of(scene);
  EXPECT_FALSE(smooth.grains.rotates());
  scene.stages.emplace_back().friction = 0.1;
  EXPECT_TRUE(state_of(scene).grains.rotates());
  fit_rotation(scene, smooth);  // a smooth packing goes on with friction
  ASSERT_TRUE(smooth.grains.rotates());
  EXPECT_NEAR(smooth.grains.spin[5].w / state_of(scene).grains.spin[5].w, 1, 1e-14);
  smooth.grains.spin[5].x = 3;
  fit_rotation(scene, smooth);
  EXPECT_EQ(smooth.grains.spin[5].x, 3);  // kept
  scene.rotation = false;
  EXPECT_FALSE(state_of(scene).grains.rotates());
}

TEST(MakePacking, CountsTheCoarseGrainsOfAGapGrading) {
  Scene scene = disks(0);
  scene.dimension = 3;
  scene.specimen.coarse_count = 60;
  auto& g = scene.specimen.grading;
  g.kind = Grading::Kind::table, g.gap = true;
  g.passing = {{0.45e-3, 0}, {0.55e-3, 0.25}, {1.8e-3, 0.25}, {2.2e-3, 1}};
  const Packing packing = make_packing(scene);
  std::size_t coarse = 0;
  double mass = 0, fines = 0;
  for (const double r : packing.radius) {
    coarse += r >= 0.9e-3;
    mass += r * r * r, fines += r < 0.5e-3 ? r * r * r : 0;
  }
  EXPECT_NEAR(static_cast<double>(coarse), 60, 1);
  EXPECT_NEAR(fines / mass, 0.25, 0.01);
}
