// The surface of a specimen, and the loads of a membrane on it.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "boundary/membrane.hpp"
#include "boundary/outer_surface.hpp"
#include "io/scene_file.hpp"
#include "support/scenes.hpp"

using namespace eg;

namespace {

constexpr double radius = 1e-3, pressure = 50e3;
constexpr double wide = 4e-3;  // probe for grains thrown at random

/// A scene whose one stage presses with `pressure` on grains between planes z = 0 and z = height (2D: y).
Scene pressed(int dimension) {
  Scene scene = test::scene_of("linear", dimension);
  scene.boundary.kind = BoundarySpec::Kind::free;
  scene.boundary.membrane.emplace();
  StageSpec stage;
  stage.membrane_stress = pressure;
  scene.stages = {stage};
  return scene;
}

State grains_at(const Scene& scene, const std::vector<Vec3>& at) {
  Packing p;
  p.dimension = scene.dimension;
  p.position = at, p.radius.assign(at.size(), radius);
  p.box = {1, 1, 1};
  return make_state(scene, p);
}

void add_platens(State& state, double height) {
  const int k = state.dimension - 1;
  Vec3 up, top;
  up[k] = 1, top[k] = height;
  test::add_plane(state, {}, up), test::add_plane(state, top, -up);
}

std::vector<Vec3> block(int nx, int ny, int nz) {
  std::vector<Vec3> at;
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) at.push_back((2 * radius) * Vec3{i + 0.5, j + 0.5, k + 0.5});
  return at;
}

Vec3 total(const State& state) {
  Vec3 sum;
  for (const auto& f : state.applied) sum += f.force;
  return sum;
}

double magnitude(const State& state) {
  double sum = 0;
  for (const auto& f : state.applied) sum += norm(f.force);
  return sum;
}

Vec3 on(const State& state, Index grain) {
  for (const auto& f : state.applied)
    if (f.grain == grain) return f.force;
  return {};
}

TEST(Membrane, ClosesAroundFreeGrains) {
  for (const int dimension : {2, 3}) {
    SCOPED_TRACE(dimension);
    Scene scene = pressed(dimension);
    scene.boundary.membrane->probe = wide;
    State state = test::cluster(scene, 300, 5);
    lay_membrane(scene, state);
    EXPECT_GT(state.applied.size(), 20u);
    EXPECT_LT(norm(total(state)), 1e-12 * magnitude(state));
    const OuterSurface surface = outer_surface(state, wide);
    Vec3 sum;
    double twice = 0;  // Gauss: ∮ x·n dA = dimension × volume
    for (const auto& f : surface.facets) {
      const auto corners = static_cast<std::size_t>(dimension);
      Vec3 middle;
      for (std::size_t k = 0; k < corners; ++k) middle += (1.0 / dimension) * f.corner[k];
      sum += f.outward(dimension), twice += dot(middle, f.outward(dimension));
      EXPECT_EQ(f.planes, 0u);
    }
    EXPECT_NEAR(twice / (dimension * surface.volume), 1, 1e-12);
    EXPECT_LT(norm(sum), 1e-12 * state.membrane.area);
  }
}

// The sum of what the membrane does to the grains, and of what the same pressure would do to the ends.
TEST(Membrane, ClosesOnPlatens) {
  Scene scene = pressed(3);
  scene.boundary.membrane->probe = wide;
  State state = test::cluster(scene, 300, 6);
  double low = 1, high = -1;
  for (const auto& p : state.grains.position) low = std::min(low, p.z - p.w), high = std::max(high, p.z + p.w);
  test::add_plane(state, {0, 0, low}, {0, 0, 1}), test::add_plane(state, {0, 0, high}, {0, 0, -1});
  lay_membrane(scene, state);
  Vec3 ends;
  for (const auto& f : outer_surface(state, wide).facets)
    if (f.planes != 0) ends += f.outward(3);
  EXPECT_GT(std::abs(ends.z), 0);
  EXPECT_NEAR(ends.x, 0, 1e-18);
  EXPECT_LT(norm(total(state) - pressure * ends), 1e-12 * magnitude(state));
}

TEST(Membrane, SquareGridCarriesItsSquare) {
  const Scene scene = pressed(3);
  State state = grains_at(scene, block(5, 5, 5));
  add_platens(state, 10 * radius);
  lay_membrane(scene, state);
  const double square = 4 * radius * radius;
  for (int k = 0; k < 5; ++k)
    for (int j = 1; j < 4; ++j) {
      const Vec3 f = on(state, static_cast<Index>((k * 5 + j) * 5));  // on the side x = R
      EXPECT_NEAR(f.x / (pressure * square), 1, 1e-12) << k << j;
      EXPECT_NEAR(norm(f - Vec3{f.x, 0, 0}), 0, 1e-12 * f.x);
    }
  EXPECT_NEAR(state.membrane.area / (4 * 8 * radius * 10 * radius), 1, 1e-12);
  EXPECT_NEAR(state.membrane.volume / (64 * square * radius * 1.25 * 2), 1, 1e-12);
  EXPECT_NEAR(norm(on(state, 62)), 0, 1e-18);  // the one in the middle
}

// Rings of m grains about an axis: the faceted area is that of a prism, 2πRH sin(π/m)/(π/m).
TEST(Membrane, AreaOfACylinder) {
  for (const int m : {12, 30}) {
    SCOPED_TRACE(m);
    const Scene scene = pressed(3);
    const double around = radius / std::sin(std::numbers::pi / m), height = 2 * 14 * radius;
    std::vector<Vec3> at;
    for (int k = 0; k < 14; ++k)
      for (int i = 0; i < m; ++i) {
        const double angle = 2 * std::numbers::pi * i / m;
        at.push_back({around * std::cos(angle), around * std::sin(angle), (2 * k + 1) * radius});
      }
    State state = grains_at(scene, at);
    add_platens(state, height);
    lay_membrane(scene, state);
    const double round = 2 * std::numbers::pi * around * height, step = std::numbers::pi / m;
    EXPECT_NEAR(state.membrane.area / (round * std::sin(step) / step), 1, 1e-9);
    EXPECT_NEAR(total(state).z, 0, 1e-12 * magnitude(state));
    EXPECT_NEAR(magnitude(state) / (pressure * round * std::sin(step) / step * std::cos(step)), 1, 1e-9);
  }
}

// Rods: a row gets half the heights to its neighbours, those at the ends all the way to the platen.
TEST(Membrane, ChainOfRods) {
  const Scene scene = pressed(2);
  const double rise = std::sqrt(3.0) * radius;
  std::vector<Vec3> at;
  for (int row = 0; row < 6; ++row)
    for (int i = 0; i < 5; ++i) at.push_back({(2 * i + row % 2) * radius, radius + row * rise, 0});
  State state = grains_at(scene, at);
  const double height = 2 * radius + 5 * rise;
  add_platens(state, height);
  lay_membrane(scene, state);
  ASSERT_EQ(state.applied.size(), 12u);
  for (Index row = 0; row < 6; ++row)
    for (const Index end : {5 * row, 5 * row + 4}) {
      const double share = row % 5 == 0 ? radius + rise / 2 : rise;
      EXPECT_NEAR(on(state, end).x / (pressure * share), end % 5 == 0 ? 1 : -1, 1e-12);
    }
  EXPECT_NEAR(state.membrane.volume / (8 * radius * height), 1, 1e-12);
}

// Side plates of plane strain close the surface too, with the edges and corners between them and the platens.
TEST(Membrane, BetweenFourPlanes) {
  const Scene scene = pressed(3);
  State state = grains_at(scene, block(4, 3, 5));
  add_platens(state, 10 * radius);
  test::add_plane(state, {}, {0, 1, 0}), test::add_plane(state, {0, 6 * radius, 0}, {0, -1, 0});
  lay_membrane(scene, state);
  EXPECT_NEAR(state.membrane.area / (2 * 60 * radius * radius), 1, 1e-12);
  EXPECT_NEAR(state.membrane.solid / (60 - 0.5 * 30) / (4. / 3 * std::numbers::pi * radius * radius * radius), 1, 1e-9);
  for (const auto& f : state.applied)
    EXPECT_NEAR(std::abs(f.force.x) / (4 * pressure * radius * radius), 1, 1e-12) << f.grain;
}

TEST(Membrane, GrainThatComesThroughIsNamed) {
  const Scene scene = pressed(3);
  auto at = block(4, 4, 4);
  at.push_back({-9 * radius, 4 * radius, 4 * radius});
  State state = grains_at(scene, at);
  add_platens(state, 8 * radius);
  try {
    lay_membrane(scene, state);
    FAIL();
  } catch (const RunError& e) {
    EXPECT_NE(std::string(e.what()).find("lets 1 grain through, grain 65 at (-0.009"), std::string::npos) << e.what();
  }
}

const std::string head = R"(
dimension = 2
[material.m]
density = 1
friction = 0
normal_stiffness = 1
shear_stiffness = 1
[contact]
law = "linear"
[specimen]
source = "lattice"
lattice = "hexagonal"
radius = 1
[boundary]
type = "box"
)";

std::string refusal(const std::string& rest) {
  try {
    parse_scene(head + rest, "scene.toml");
  } catch (const InputError& e) {
    return e.what();
  }
  return {};
}

TEST(Membrane, StagesAreHeldTogether) {
  const std::string stage = "[[stage]]\nname = \"a\"\nuntil = { steps = 1 }\n",
                    second = "[[stage]]\nname = \"b\"\nuntil = { steps = 1 }\n", load = "membrane = { stress = 1 }\n",
                    skin = "[boundary.membrane]\n";
  EXPECT_EQ(refusal(skin + stage + load + second + load), "");
  EXPECT_NE(refusal(stage + load).find("needs a membrane"), std::string::npos);
  EXPECT_NE(refusal(skin + stage + load + second).find("is missing, though stage \"a\""), std::string::npos);
  EXPECT_NE(refusal(stage + "remove = [\"left\"]\n").find("which is no body"), std::string::npos);
  EXPECT_NE(refusal(stage + "remove = [\"x_low\"]\n" + second + "body.x_low = { force = 1 }\n").find("been removed"),
            std::string::npos);
}

}  // namespace
