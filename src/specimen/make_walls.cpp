#include "specimen/make_walls.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.hpp"
#include "state/wall_geometry.hpp"

namespace eg {
namespace {

std::uint16_t material_index(const Scene& scene, const std::string& name) {
  const auto found = std::ranges::find(scene.materials, name, &Material::name);
  if (found == scene.materials.end())
    throw input_error(scene.file, 0, fmt::format("wall material \"{}\"", name), "is not a material of the scene",
                      fmt::format("add [material.{}]", name));
  return static_cast<std::uint16_t>(found - scene.materials.begin());
}

void add_box(const Scene& scene, const Vec3& box, State& state) {
  const auto material = [&](Index body) {
    const auto& own = scene.boundary.bodies[body].material;
    return material_index(scene, own.empty() ? scene.boundary.wall_material : own);
  };
  for (int k = 0; k < scene.dimension; ++k) {
    Wall lower, upper;
    lower.normal[k] = 1, upper.normal[k] = -1;
    upper.point[k] = box[k];
    lower.body = static_cast<Index>(2 * k), upper.body = lower.body + 1;
    lower.material = material(lower.body), upper.material = material(upper.body);
    state.walls.push_back(lower), state.walls.push_back(upper);
  }
}

Wall wall_of(const Scene& scene, const WallSpec& spec) {
  Wall wall;
  wall.shape = spec.shape == WallSpec::Shape::plane ? Wall::plane : Wall::cylinder;
  wall.point = spec.point, wall.normal = (1 / norm(spec.normal)) * spec.normal;
  if (wall.shape == Wall::cylinder) wall.radius = spec.radius, wall.hollow = spec.hollow, wall.angle = spec.angle;
  wall.along = spec.along, wall.low = spec.window[0], wall.high = spec.window[1];
  wall.body = static_cast<Index>(spec.body);
  wall.material = material_index(scene, spec.material);
  return wall;
}

// Corners of a mesh are told apart by their coordinates, which the reader has made equal where they coincide.
using Key = std::array<double, 3>;
Key key(const Vec3& x) { return {x.x, x.y, x.z}; }

struct Side {
  Index face;        ///< number among the mesh's facets
  std::size_t edge;  ///< from corner `edge` to the next one
};

/// A mesh as faces, rims and tips.
class MeshWalls {
 public:
  MeshWalls(std::vector<std::array<Vec3, 3>> facets, const Wall& common, State& state)
      : facets_(std::move(facets)), common_(common), state_(state), first_(static_cast<Index>(state.walls.size())) {
    for (const auto& f : facets_) add_face(f);
    for (Index f = 0; f < facets_.size(); ++f)
      for (std::size_t k = 0; k < 3; ++k)
        edges_[std::minmax(key(facets_[f][k]), key(facets_[f][(k + 1) % 3]))].push_back({f, k});
    for (const auto& [ends, sides] : edges_) add_rim(sides);
    for (const auto& [corner, spokes] : spokes_)
      if (sharp_.contains(corner)) add_tip({corner[0], corner[1], corner[2]}, spokes);
  }

 private:
  Wall& face(Index f) { return state_.walls[first_ + f]; }

  void add_face(const std::array<Vec3, 3>& f) {
    Wall wall = common_;
    wall.shape = Wall::face;
    wall.point = f[0], wall.side_b = f[1] - f[0], wall.side_c = f[2] - f[0];
    const Vec3 normal = cross(wall.side_b, wall.side_c);
    wall.normal = (1 / norm(normal)) * normal;
    state_.walls.push_back(wall);
  }

  /// Unit vector in the face, across its edge, inwards.
  Vec3 inwards(const Side& s, const Vec3& edge) { return cross(face(s.face).normal, edge); }

  void add_rim(const std::vector<Side>& sides) {
    const Side& s = sides[0];
    const Vec3 a = facets_[s.face][s.edge], b = facets_[s.face][(s.edge + 1) % 3];
    const double length = norm(b - a);
    const Vec3 edge = (1 / length) * (b - a);
    spokes_[key(a)].push_back(edge), spokes_[key(b)].push_back(-edge);
    Wall rim = common_;
    rim.shape = Wall::rim;
    rim.point = a, rim.normal = edge, rim.length = length;
    rim.side_b = inwards(s, edge);
    if (sides.size() > 1) {
      rim.side_c = inwards(sides[1], -edge);
      const double fold = dot(rim.side_c, face(s.face).normal);  // < 0: stands out, 0: one plane, > 0: a dent
      if (fold > -1e-9) {
        face(s.face).owned |= static_cast<std::uint8_t>(1u << s.edge);
        return;
      }
    }
    state_.walls.push_back(rim);
    sharp_[key(a)] = sharp_[key(b)] = true;
  }

  void add_tip(const Vec3& corner, const std::vector<Vec3>& spokes) {
    Wall tip = common_;
    tip.shape = Wall::tip;
    tip.point = corner;
    tip.spoke = static_cast<Index>(state_.spokes.size()), tip.spokes = static_cast<Index>(spokes.size());
    state_.spokes.insert(state_.spokes.end(), spokes.begin(), spokes.end());
    state_.walls.push_back(tip);
  }

  std::vector<std::array<Vec3, 3>> facets_;
  Wall common_;
  State& state_;
  Index first_;
  std::map<std::pair<Key, Key>, std::vector<Side>> edges_;
  std::map<Key, std::vector<Vec3>> spokes_;
  std::map<Key, bool> sharp_;
};

void add_mesh(const Scene& scene, const MeshSpec& mesh, State& state) {
  Wall common;
  common.body = static_cast<Index>(mesh.body);
  common.material = material_index(scene, mesh.material);
  common.hollow = mesh.hollow;
  auto facets = mesh.facets;
  if (mesh.hollow)
    for (auto& f : facets) std::swap(f[1], f[2]);
  MeshWalls(std::move(facets), common, state);
}

void make_bodies(const Scene& scene, State& state) {
  double mass = 0;
  for (const auto& v : state.grains.velocity) mass += v.w > 0 ? 1 / v.w : 0;
  for (const auto& spec : scene.boundary.bodies) {
    const auto alike = std::ranges::count(scene.boundary.bodies, spec.group, &BodySpec::group);
    Body body;
    body.mass = std::isnan(spec.mass) ? mass / (spec.group.empty() ? 1. : static_cast<double>(alike)) : spec.mass;
    state.bodies.push_back(body);
  }
}

/// A grain's centre behind a plane, outside a hollow cylinder or inside a solid one.
void check_sides(const Scene& scene, const State& state) {
  for (std::size_t w = 0; w < state.walls.size(); ++w) {
    const Wall& wall = state.walls[w];
    if (wall.shape > Wall::cylinder) continue;
    for (std::size_t i = 0; i < state.grains.size(); ++i) {
      const Quad& p = state.grains.position[i];
      if (grain_wall(state, wall, p.vec(), p.w, Arms::middle).overlap <= p.w) continue;
      throw input_error(scene.file, 0, fmt::format("grain {}", i + 1),
                        fmt::format("at ({:.6g}, {:.6g}, {:.6g}) m lies behind a wall of \"{}\"", p.x, p.y, p.z,
                                    scene.boundary.bodies[wall.body].name),
                        "move the wall, turn its normal round, or make the specimen fit between the walls");
    }
  }
}

}  // namespace

void make_walls(const Scene& scene, const Vec3& box, State& state) {
  make_bodies(scene, state);
  if (scene.boundary.kind == BoundarySpec::Kind::box) add_box(scene, box, state);
  for (const auto& spec : scene.boundary.walls) state.walls.push_back(wall_of(scene, spec));
  for (const auto& mesh : scene.boundary.meshes) add_mesh(scene, mesh, state);
  check_sides(scene, state);
}

}  // namespace eg
