// Where grains meet walls: shapes, windows, meshes.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "base/random.hpp"
#include "io/scene_file.hpp"
#include "io/stl.hpp"
#include "io/text_file.hpp"
#include "scratch.hpp"
#include "specimen/make_walls.hpp"
#include "state/wall_geometry.hpp"

using namespace eg;

namespace {

using Mesh = std::vector<std::array<Vec3, 3>>;

/// The surface of a box, two facets a side, seen from outside counter-clockwise.
Mesh box_mesh(const Vec3& low, const Vec3& high) {
  const auto at = [&](int i, int j, int k) { return Vec3{i ? high.x : low.x, j ? high.y : low.y, k ? high.z : low.z}; };
  Mesh mesh;
  const auto side = [&](Vec3 a, Vec3 b, Vec3 c, Vec3 d) { mesh.push_back({a, b, c}), mesh.push_back({a, c, d}); };
  side(at(0, 0, 0), at(0, 1, 0), at(1, 1, 0), at(1, 0, 0)), side(at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1));
  side(at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1)), side(at(0, 1, 0), at(0, 1, 1), at(1, 1, 1), at(1, 1, 0));
  side(at(0, 0, 0), at(0, 0, 1), at(0, 1, 1), at(0, 1, 0)), side(at(1, 0, 0), at(1, 1, 0), at(1, 1, 1), at(1, 0, 1));
  return mesh;
}

Scene scene_with(const Mesh& mesh, bool hollow) {
  Scene scene;
  Material m;
  m.name = "grain";
  scene.materials = {m};
  scene.boundary.kind = BoundarySpec::Kind::free;
  scene.boundary.bodies.resize(1);
  MeshSpec spec;
  spec.facets = mesh, spec.hollow = hollow, spec.material = "grain";
  scene.boundary.meshes = {spec};
  return scene;
}

/// Walls that a sphere overlaps.
std::vector<Geometry<double>> touches(const State& state, const Vec3& x, double radius) {
  std::vector<Geometry<double>> found;
  for (const auto& wall : state.walls)
    if (const auto g = grain_wall(state, wall, x, radius, Arms::middle); g.overlap > 0) found.push_back(g);
  return found;
}

double distance_to_box(const Vec3& x, const Vec3& low, const Vec3& high) {
  Vec3 d;
  for (int k = 0; k < 3; ++k) d[k] = std::max({low[k] - x[k], 0.0, x[k] - high[k]});
  return norm(d);
}

TEST(Walls, CylinderFromInsideAndOutside) {
  const State state;
  Wall wall;
  wall.shape = Wall::cylinder, wall.point = {1, 2, 3}, wall.normal = {0, 0, 1}, wall.radius = 5;
  auto g = grain_wall(state, wall, Vec3{1 + 3, 2 + 4 - 1e-9, -7}, 0.25, Arms::surface);
  EXPECT_NEAR(g.overlap, 0.25, 1e-8);
  EXPECT_NEAR(g.n.x, 0.6, 1e-8);
  EXPECT_NEAR(g.n.y, 0.8, 1e-8);
  wall.hollow = false;
  g = grain_wall(state, wall, Vec3{1 + 3.6, 2 + 4.8, 0}, 1.5, Arms::middle);
  EXPECT_NEAR(g.overlap, 0.5, 1e-12);
  EXPECT_NEAR(g.arm_i, 1.25, 1e-12);
  EXPECT_NEAR(g.n.x, -0.6, 1e-12);
}

TEST(Walls, WindowTakesGrainsByTheirCentre) {
  const State state;
  Wall wall;
  wall.normal = {1, 0, 0}, wall.along = {0, 0, 1}, wall.low = -1, wall.high = 2;
  const auto at = [&](double x, double z) { return grain_wall(state, wall, Vec3{x, 0, z}, 0.5, Arms::middle); };
  for (const double z : {-1.0, 0.0, 1.999}) EXPECT_NEAR(at(0.4, z).overlap, 0.1, 1e-15);
  for (const double z : {-1.31, 2.31, 5.0}) EXPECT_LT(at(0.4, z).overlap, 0);
  EXPECT_NEAR(at(0.3, 2.4).overlap, 0, 1e-15);  // the corner
  EXPECT_NEAR(at(0.3, 2.1).n.z, -0.1 / std::hypot(0.3, 0.1), 1e-12);
  EXPECT_NEAR(at(0.3, -1.1).n.z, 0.1 / std::hypot(0.3, 0.1), 1e-12);
  EXPECT_NEAR(at(-3, 2.4).overlap, 0.1, 1e-15);  // the ledge
  EXPECT_EQ(at(-3, 2.4).n.z, -1);
  for (const double z : {-1.0, 2.0}) EXPECT_NEAR(at(0.4, z - 1e-12).overlap, at(0.4, z + 1e-12).overlap, 1e-11);
}

TEST(Walls, ASphereTouchesABlockOnceWhereverItComes) {
  const Vec3 low{-1, -2, -0.5}, high{1, 1, 0.5};
  State state;
  make_walls(scene_with(box_mesh(low, high), false), {}, state);
  EXPECT_EQ(state.walls.size(), 12u + 12u + 8u);  // faces, rims, tips; the sides' diagonals are flat
  Random random(3);
  int met = 0;
  for (int k = 0; k < 20000; ++k) {
    Vec3 x{random.uniform(-2, 2), random.uniform(-3, 2), random.uniform(-1.5, 1.5)};
    if (k % 4 == 0) x = {0.25 * std::round(4 * x.x), 0.25 * std::round(4 * x.y), 0.25 * std::round(4 * x.z)};
    const double d = distance_to_box(x, low, high), radius = 0.4;
    if (d == 0) continue;
    const auto g = touches(state, x, radius);
    ASSERT_EQ(g.size(), d < radius ? 1u : 0u) << x.x << ' ' << x.y << ' ' << x.z;
    if (g.empty()) continue;
    ++met;
    EXPECT_NEAR(g[0].overlap, radius - d, 1e-12);
    EXPECT_NEAR(distance_to_box(x + d * g[0].n, low, high), 0, 1e-12);
  }
  EXPECT_GT(met, 2000);
}

TEST(Walls, ASphereInAHollowBlockTouchesItsSides) {
  State state;
  make_walls(scene_with(box_mesh({0, 0, 0}, {1, 1, 1}), true), {}, state);
  EXPECT_EQ(state.walls.size(), 12u);  // dents have no rims
  EXPECT_EQ(touches(state, {0.5, 0.5, 0.5}, 0.4).size(), 0u);
  EXPECT_EQ(touches(state, {0.3, 0.3, 0.5}, 0.4).size(), 2u);  // over the diagonal of neither side twice
  EXPECT_EQ(touches(state, {0.3, 0.3, 0.3}, 0.4).size(), 3u);
}

/// Random cones over a ring of corners: each contact belongs to exactly one part, the nearest one.
TEST(Walls, ConeTipAndRims) {
  Random random(5);
  for (int trial = 0; trial < 20; ++trial) {
    const int n = 3 + trial;
    const double height = random.uniform(0.3, 3);
    Mesh mesh;
    const auto ring = [&](int k) {
      const double a = 2 * std::numbers::pi * k / n;
      return Vec3{std::cos(a), std::sin(a), 0};
    };
    for (int k = 0; k < n; ++k) {
      mesh.push_back({ring(k), ring((k + 1) % n), {0, 0, height}});
      mesh.push_back({ring((k + 1) % n), ring(k), {0, 0, 0}});
    }
    State state;
    make_walls(scene_with(mesh, false), {}, state);
    for (int k = 0; k < 400; ++k) {
      const Vec3 x{random.uniform(-1, 1), random.uniform(-1, 1), height + random.uniform(0, 0.5)};
      const auto g = touches(state, x, 0.45);
      EXPECT_LE(g.size(), 1u);
      if (norm(x - Vec3{0, 0, height}) < 0.44) {
        EXPECT_EQ(g.size(), 1u);
      }
    }
  }
}

std::string ascii(const Mesh& mesh) {
  std::string text = "solid a\n";
  for (const auto& f : mesh) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const auto& x : f)
      text += "vertex " + std::to_string(x.x) + " " + std::to_string(x.y) + " " + std::to_string(x.z) + "\n";
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid a\n";
}

std::string binary(const Mesh& mesh) {
  std::string bytes(80, ' ');
  const auto put = [&](const auto& x) { bytes.append(reinterpret_cast<const char*>(&x), sizeof x); };
  put(static_cast<std::uint32_t>(mesh.size()));
  for (const auto& f : mesh) {
    for (int k = 0; k < 3; ++k) put(0.0f);
    for (const auto& x : f) put(static_cast<float>(x.x)), put(static_cast<float>(x.y)), put(static_cast<float>(x.z));
    put(std::uint16_t{0});
  }
  return bytes;
}

std::string fault(const Scratch& scratch, const std::string& name, bool open = false) {
  MeshSpec mesh;
  mesh.path = name, mesh.open = open;
  try {
    read_mesh_file(mesh, scratch.folder());
  } catch (const InputError& e) {
    const std::string text = e.what();
    return text.substr(text.find(name) + name.size());
  }
  return "";
}

TEST(Stl, AsciiAndBinaryGiveTheSameMesh) {
  const Scratch scratch;
  const Mesh mesh = box_mesh({0, 0, 0}, {1, 2, 0.5});
  write_file(scratch / "a.stl", ascii(mesh)), write_file(scratch / "b.stl", binary(mesh));
  MeshSpec a, b;
  a.path = "a.stl", b.path = "b.stl", a.scale = b.scale = 1e-3, a.offset = b.offset = {1, 1, 1};
  read_mesh_file(a, scratch.folder()), read_mesh_file(b, scratch.folder());
  ASSERT_EQ(a.facets.size(), 12u);
  for (std::size_t f = 0; f < 12; ++f)
    for (std::size_t k = 0; k < 3; ++k) EXPECT_LT(norm(a.facets[f][k] - b.facets[f][k]), 1e-15);
  EXPECT_EQ(a.facets[11][0].x, 1.001);
}

TEST(Stl, DamageIsNamed) {
  const Scratch scratch;
  Mesh mesh = box_mesh({0, 0, 0}, {1, 1, 1});
  const auto write = [&](const Mesh& m) { write_file(scratch / "m.stl", binary(m)); };
  Mesh hole = mesh;
  hole.pop_back();
  write(hole);
  EXPECT_NE(fault(scratch, "m.stl").find("the mesh has a hole; close it, or say open = true"), std::string::npos);
  EXPECT_EQ(fault(scratch, "m.stl", true), "");
  Mesh flipped = mesh;
  std::swap(flipped[4][0], flipped[4][1]);
  write(flipped);
  EXPECT_NE(fault(scratch, "m.stl").find("face opposite sides"), std::string::npos);
  Mesh inward = mesh;
  for (auto& f : inward) std::swap(f[0], f[1]);
  write(inward);
  EXPECT_NE(fault(scratch, "m.stl").find("faces inward everywhere"), std::string::npos);
  Mesh thin = mesh;
  thin[3][2] = thin[3][1];
  write(thin);
  EXPECT_NE(fault(scratch, "m.stl").find("facet 4 has no area"), std::string::npos);
  write_file(scratch / "cut.stl", binary(mesh).substr(0, 300));
  EXPECT_NE(fault(scratch, "cut.stl").find("is no STL file"), std::string::npos);
  EXPECT_NE(fault(scratch, "none.stl"), "");
}

}  // namespace
