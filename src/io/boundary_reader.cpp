#include "io/boundary_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace eg {

namespace {

constexpr auto required = Need::required;
constexpr double infinite = std::numeric_limits<double>::infinity();

std::size_t body_named(BoundarySpec& b, const std::string& name, const std::string& group = {}) {
  for (std::size_t k = 0; k < b.bodies.size(); ++k)
    if (b.bodies[k].name == name) return k;
  b.bodies.push_back({.name = name, .group = group, .velocity = {}, .material = {}});
  return b.bodies.size() - 1;
}

std::string read_material_name(const TomlReader& t, const Scene& scene, std::string_view key = "material") {
  std::string name = scene.materials[0].name;
  t.choice(key, name, material_names(scene), scene.materials.size() > 1 ? required : Need::optional);
  return name;
}

/// name, body and velocity: a wall makes a body of its own unless it names another's.
std::size_t read_body_of(const TomlReader& t, const Scene& scene, BoundarySpec& b, std::string& name) {
  t.name("name", name, required);
  std::string body = name;
  t.name("body", body);
  const std::size_t index = body_named(b, body);
  Vec3 velocity;
  if (t.vector("velocity", scene.dimension, velocity)) b.bodies[index].velocity = velocity;
  return index;
}

/// window = { axis = "z", min = …, max = … } in the coordinates of the scene.
void read_window(const TomlReader& t, int dimension, WallSpec& wall) {
  std::string axis;
  t.choice("axis", axis, dimension == 3 ? std::vector<std::string>{"x", "y", "z"} : std::vector<std::string>{"x", "y"},
           required);
  const int k = axis[0] - 'x';
  wall.along[k] = 1;
  if (t.number("min", wall.window[0])) wall.window[0] -= wall.point[k];
  if (t.number("max", wall.window[1])) wall.window[1] -= wall.point[k];
  if (!(wall.window[0] < wall.window[1])) throw t.error("max", "must be above min");
  t.finish();
}

void read_plane(const TomlReader& t, int dimension, WallSpec& wall) {
  t.direction("normal", dimension, wall.normal, required);
  for (const char* key : {"axis", "radius", "grains", "height", "angle"})
    if (t.has(key)) throw t.error(key, "is read with shape = \"cylinder\" only", "remove it or set the shape");
}

void read_cylinder(const TomlReader& t, int dimension, WallSpec& wall) {
  wall.shape = WallSpec::Shape::cylinder;
  wall.normal = {0, 0, 1};
  if (dimension == 3) t.direction("axis", dimension, wall.normal);
  t.number("radius", wall.radius, positive, required);
  t.choice<bool>("grains", wall.hollow, {{"inside", true}, {"outside", false}});
  if (dimension == 2) wall.height = 1;
  if (dimension == 3) t.number("height", wall.height, positive);
  if (double degrees = 0; t.number("angle", degrees, above_up_to(0, 360)))
    wall.angle = degrees * std::numbers::pi / 180;
  if (t.has("normal")) throw t.error("normal", "is read with shape = \"plane\" only", "give the axis of a cylinder");
}

WallSpec read_wall(const TomlReader& t, const Scene& scene, BoundarySpec& b) {
  WallSpec wall;
  wall.body = read_body_of(t, scene, b, wall.name);
  bool round = false;
  t.choice<bool>("shape", round, {{"plane", false}, {"cylinder", true}});
  t.vector("point", scene.dimension, wall.point, required);
  round ? read_cylinder(t, scene.dimension, wall) : read_plane(t, scene.dimension, wall);
  if (const auto window = t.table("window")) read_window(*window, scene.dimension, wall);
  wall.material = read_material_name(t, scene);
  t.finish();
  return wall;
}

/// A stack of rings: cylinders that share an axis, one upon the other, each a body NAME1, NAME2, … counted from
/// `point`.
void read_rings(const TomlReader& t, const Scene& scene, BoundarySpec& b) {
  if (scene.dimension != 3) throw t.error("", "is read in 3D only", "use walls with a window");
  std::string name;
  WallSpec ring;
  int count = 0;
  double height = 0, mass = not_given;
  t.name("name", name, required);
  t.integer("count", count, closed(1, 10000), required);
  t.vector("point", 3, ring.point, required);
  ring.normal = {0, 0, 1};
  t.direction("axis", 3, ring.normal);
  t.number("radius", ring.radius, positive, required);
  t.number("height", height, positive, required);
  t.number("mass", mass, positive);
  ring.material = read_material_name(t, scene);
  t.finish();
  ring.shape = WallSpec::Shape::cylinder;
  ring.along = ring.normal;
  ring.height = height / count;
  for (int k = 0; k < count; ++k) {
    ring.name = fmt::format("{}{}", name, k + 1);
    ring.body = body_named(b, ring.name, name);
    b.bodies[ring.body].mass = mass;
    ring.window = {k == 0 ? -infinite : k * height / count, k + 1 == count ? infinite : (k + 1) * height / count};
    b.walls.push_back(ring);
  }
}

MeshSpec read_mesh(const TomlReader& t, const Scene& scene, BoundarySpec& b) {
  if (scene.dimension != 3) throw t.error("", "is read in 3D only", "use walls");
  MeshSpec mesh;
  std::string name;
  mesh.body = read_body_of(t, scene, b, name);
  t.text("file", mesh.path, required);
  t.number("scale", mesh.scale, positive);
  t.vector("offset", 3, mesh.offset);
  t.choice<bool>("grains", mesh.hollow, {{"inside", true}, {"outside", false}});
  t.flag("open", mesh.open);
  mesh.material = read_material_name(t, scene);
  t.finish();
  return mesh;
}

void read_body_table(const TomlReader& t, const Scene& scene, BoundarySpec& b) {
  for (const auto& [name, body] : t.named_tables()) {
    BodySpec* found = nullptr;
    for (auto& spec : b.bodies)
      if (spec.name == name) found = &spec;
    if (!found) throw t.error(name, "is not the name of a wall, mesh or ring", "name a body that the boundary has");
    body.number("mass", found->mass, positive);
    body.number("area", found->area, positive);
    const bool of_box = b.kind == BoundarySpec::Kind::box && found < &b.bodies[0] + 2 * scene.dimension;
    if (body.choice("material", found->material, material_names(scene)) && !of_box)
      throw body.error("material", "is read for the sides of a box", "give it to the wall or mesh");
    body.finish();
  }
}

MembraneSpec read_membrane(const TomlReader& t) {
  MembraneSpec membrane;
  t.number("probe", membrane.probe, positive);
  t.finish();
  return membrane;
}

void check_names(const TomlReader& t, const BoundarySpec& b) {
  for (std::size_t k = 0; k < b.walls.size(); ++k)
    for (std::size_t l = 0; l < k; ++l)
      if (b.walls[k].name == b.walls[l].name)
        throw t.error("name", fmt::format("\"{}\" is the name of another wall already", b.walls[k].name));
}

/// The bodies a name stands for: one, or a whole stack of rings.
std::vector<std::size_t> bodies_of(const BoundarySpec& b, const std::string& name) {
  std::vector<std::size_t> found;
  for (std::size_t k = 0; k < b.bodies.size(); ++k)
    if (b.bodies[k].name == name || b.bodies[k].group == name) found.push_back(k);
  return found;
}

std::string known_bodies(const BoundarySpec& b) {
  std::string names;
  for (const auto& body : b.bodies)
    if (const auto& name = body.group.empty() ? body.name : body.group; !names.ends_with(name))
      names += (names.empty() ? "" : ", ") + name;
  return names.empty() ? "the boundary has none" : "bodies here: " + names;
}

bool is_round(const BoundarySpec& b, std::size_t body) {
  for (const auto& wall : b.walls)
    if (wall.body == body && wall.shape == WallSpec::Shape::cylinder) return true;
  return false;
}

/// Out of the specimen, against the normal of the body's first plane. Zero when it has none.
Vec3 outward(const BoundarySpec& b, std::size_t body, int dimension) {
  const std::size_t sides = b.kind == BoundarySpec::Kind::box ? 2 * static_cast<std::size_t>(dimension) : 0;
  Vec3 out;
  if (body < sides) out[static_cast<int>(body / 2)] = body % 2 == 0 ? -1 : 1;
  if (body < sides) return out;
  for (const auto& wall : b.walls)
    if (wall.body == body && wall.shape == WallSpec::Shape::plane) return -wall.normal;
  return out;
}

void read_servo(const TomlReader& t, const Scene& scene, BodyDrive& drive) {
  using Servo = BodyDrive::Servo;
  const bool force = t.number("force", drive.target, non_negative);
  const bool stress = t.number("stress", drive.target, non_negative);
  const bool radial = t.number("radial_stress", drive.target, non_negative);
  if (force + stress + radial > 1) throw t.error("", "has several targets", "give one of force, stress, radial_stress");
  drive.servo = force ? Servo::force : stress || radial ? Servo::stress : Servo::none;
  drive.radial = radial;
  const bool directed = t.direction("along", scene.dimension, drive.along);
  if (drive.servo == Servo::none) {
    for (const char* key : {"along", "max_speed", "region"})
      if (t.has(key)) throw t.error(key, "needs a force or a stress to aim at", "remove it or add one");
    return;
  }
  t.number("max_speed", drive.max_speed, positive);
  if (radial) {
    if (!is_round(scene.boundary, drive.body))
      throw t.error("radial_stress", "needs a cylinder", "use stress, which acts along the normal of a plane");
    if (t.has("region")) throw t.error("region", "needs a direction", "use stress along a plane's normal");
    return;
  }
  if (!directed) drive.along = outward(scene.boundary, drive.body, scene.dimension);
  if (const auto region = t.table("region")) {
    drive.region.emplace();
    region->vector("centre", scene.dimension, drive.region->centre, required);
    region->number("radius", drive.region->radius, positive, required);
    region->finish();
    if (!stress || !(drive.target > 0))
      throw t.error("region", "needs a stress above 0 to aim at there", "give stress along a plane's normal");
  }
  if (norm(drive.along) == 0)
    throw t.error(force ? "force" : "stress", "has no direction: the body has no plane",
                  "add along = [x, y, z], pointing out of the specimen");
}

BodyDrive read_drive(const TomlReader& t, const Scene& scene, std::size_t body) {
  BodyDrive drive;
  drive.body = body;
  drive.velocity = scene.boundary.bodies[body].velocity;
  t.vector("velocity", scene.dimension, drive.velocity);
  if (t.number("opening", drive.opening) && !is_round(scene.boundary, body))
    throw t.error("opening", "needs a cylinder, whose radius grows at this rate [m/s]", "use velocity");
  read_servo(t, scene, drive);
  std::vector<std::string> axes;
  if (t.choices("free", axes,
                scene.dimension == 3 ? std::vector<std::string>{"x", "y", "z"} : std::vector<std::string>{"x", "y"}))
    for (const auto& axis : axes) drive.free[static_cast<std::size_t>(axis[0] - 'x')] = true;
  if (!axes.empty() && drive.servo != BodyDrive::Servo::none)
    throw t.error("free", "cannot stand beside a servo", "let the body go free, or aim at a force");
  if (drive.servo != BodyDrive::Servo::none && !drive.radial && std::abs(dot(drive.velocity, drive.along)) > 0)
    throw t.error("velocity", "moves the body along the direction that its servo drives",
                  "remove that component: the servo decides it");
  t.finish();
  return drive;
}

std::vector<std::size_t> named_bodies(const TomlReader& stage, std::string_view key, const BoundarySpec& b) {
  std::vector<std::string> names;
  stage.texts(key, names);
  std::vector<std::size_t> all;
  for (const auto& name : names) {
    const auto found = bodies_of(b, name);
    if (found.empty()) throw stage.error(key, fmt::format("names \"{}\", which is no body", name), known_bodies(b));
    all.insert(all.end(), found.begin(), found.end());
  }
  return all;
}

/// In this stage or one before.
bool removed(const Scene& scene, const StageSpec& stage, std::size_t body) {
  const auto in = [body](const StageSpec& s) { return std::ranges::find(s.removed, body) != s.removed.end(); };
  return in(stage) || std::ranges::any_of(scene.stages, in);
}

/// A stage that follows one with pressure must say how it goes on.
void read_membrane_stress(const TomlReader& stage, const Scene& scene, StageSpec& out) {
  const auto table = stage.table("membrane");
  if (table && !scene.boundary.membrane)
    throw stage.error("membrane", "needs a membrane", "add [boundary.membrane] to the scene");
  if (!table && !scene.stages.empty() && scene.stages.back().membrane_stress > 0)
    throw stage.error("membrane",
                      fmt::format("is missing, though stage \"{}\" before has a pressure", scene.stages.back().name),
                      "say membrane = { stress = … }, 0 to take it off");
  if (!table) return;
  table->number("stress", out.membrane_stress, non_negative, required);
  table->finish();
}

}  // namespace

std::vector<std::string> material_names(const Scene& scene) {
  std::vector<std::string> names;
  for (const auto& m : scene.materials) names.push_back(m.name);
  return names;
}

void read_boundary(const TomlReader& t, Scene& scene) {
  using Kind = BoundarySpec::Kind;
  auto& b = scene.boundary;
  t.choice<Kind>("type", b.kind, {{"periodic", Kind::periodic}, {"free", Kind::free}, {"box", Kind::box}}, required);
  if (b.kind == Kind::box) {
    b.wall_material = read_material_name(t, scene, "wall_material");
    b.bodies = box_bodies(scene.dimension);
  } else if (t.has("wall_material")) {
    throw t.error("wall_material", "is read with type = \"box\" only", "remove one of the two");
  }
  for (const char* key : {"wall", "rings", "mesh", "membrane"})
    if (b.kind == Kind::periodic && t.has(key))
      throw t.error(key, "cannot stand in a cell that is periodic in every direction",
                    "set boundary.type to \"free\" or \"box\"");
  for (const auto& wall : t.tables("wall")) b.walls.push_back(read_wall(wall, scene, b));
  for (const auto& rings : t.tables("rings")) read_rings(rings, scene, b);
  for (const auto& mesh : t.tables("mesh")) b.meshes.push_back(read_mesh(mesh, scene, b));
  if (const auto bodies = t.table("body")) read_body_table(*bodies, scene, b);
  if (const auto membrane = t.table("membrane")) b.membrane = read_membrane(*membrane);
  check_names(t, b);
  t.finish();
}

void read_bodies(const TomlReader& stage, const Scene& scene, StageSpec& out) {
  const BoundarySpec& b = scene.boundary;
  out.removed = named_bodies(stage, "remove", b);
  if (const auto table = stage.table("body"))
    for (const auto& [name, body] : table->named_tables()) {
      const auto found = bodies_of(b, name);
      if (found.empty()) throw table->error(name, "is no body of the boundary", known_bodies(b));
      for (const std::size_t k : found) {
        if (removed(scene, out, k)) throw table->error(name, "has been removed", "drive it in stages before that only");
        out.bodies.push_back(read_drive(body, scene, k));
      }
    }
  out.glue = named_bodies(stage, "glue", b);
  read_membrane_stress(stage, scene, out);
}

}  // namespace eg
