#include "boundary/body_control.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "measure/measure_sphere.hpp"
#include "measure/volume.hpp"
#include "state/gather.hpp"
#include "state/wall_geometry.hpp"

namespace eg {
namespace {

constexpr double gain = 0.5;            // α; the proof needs α ≤ 2/3, the rest is room for K to grow within a step
constexpr double patience = 400;        // steps in which the part that builds up takes over a lasting speed
constexpr double near_target = 0.01;    // it sets in there, or the servo would overshoot
constexpr double ease = 0.2;            // of the target: from there on a servo approaches it at less than full speed
constexpr double slow_enough = 2.5e-3;  // inertial number below which straining is quasi-static

constexpr std::uint64_t region_steps = 100;  // between looks into a servo's region
constexpr double region_gain = 0.1;          // share of what it lacks that the boundary's target moves by
constexpr double runaway = 2;                // edges of the specimen's box that a servo may move its body by
constexpr double most_correction = 0.8;      // of the target: an empty region does not run away with the wall

using Servo = BodyDrive::Servo;

int main_axis(const Vec3& v) {
  for (int k = 0; k < 3; ++k)
    if (std::abs(v[k]) > 1 - 1e-9) return k;
  return -1;
}

/// Distance between the planes across axis k; NaN where there are none.
double span(const State& state, int k) {
  const double gap = wall_gap(state, k).length();
  return std::isfinite(gap) ? gap : not_given;
}

const WallSpec* cylinder_of(const BoundarySpec& b, std::size_t body) {
  for (const auto& wall : b.walls)
    if (wall.body == body && wall.shape == WallSpec::Shape::cylinder) return &wall;
  return nullptr;
}

const Wall* wall_of(const State& state, std::size_t body, std::uint8_t shape) {
  for (const auto& wall : state.walls)
    if (wall.body == body && wall.shape == shape) return &wall;
  return nullptr;
}

/// Of a body's cylinder, as far as grains press on it.
double round_area(const Scene& scene, const State& state, std::size_t body) {
  const WallSpec& spec = *cylinder_of(scene.boundary, body);
  const int axis = main_axis(spec.normal);
  const double height = std::isnan(spec.height) && axis >= 0 ? span(state, axis) : spec.height;
  return spec.angle * wall_of(state, body, Wall::cylinder)->radius * height;
}

/// Sets the area across `along`: of a ring between a hollow cylinder with that axis and a solid one, else the mean
/// section inside a membrane, else of the box between planes.
void set_flat_area(const State& state, const Vec3& along, BodyLoad& load) {
  load.area = round_section(state, along);
  if (load.area > 0) return;
  load.area = not_given;
  const int axis = main_axis(along);
  if (axis < 0) return;
  const Membrane& membrane = state.membrane;
  if (membrane.volume > 0) {
    load.area = membrane.volume / span(state, axis);
    const Extent gap = wall_gap(state, axis);
    const double across = along[axis] < 0 ? gap.high : gap.low;  // the other end, about which the loads are balanced
    load.bias = (membrane.moment[axis] - membrane.net[axis] * across) / gap.length();
    return;
  }
  load.area = 1;
  for (int k = 0; k < state.dimension; ++k)
    if (k != axis) load.area *= span(state, k);
}

/// On the boundary.
double target_force(const Scene& scene, const State& state, const BodyDrive& drive) {
  if (drive.servo == Servo::force) return drive.target;
  const BodyLoad load = body_load(scene, state, drive);
  return (drive.target + state.bodies[drive.body].correction) * load.area + load.bias;
}

/// Mean normal stress along `along` in a sphere [Pa]: the windows of measure/measure_sphere.hpp.
double stress_inside(const Scene& scene, const State& state, const ServoRegion& region, const Vec3& along) {
  const MeasureSphere sphere{region.centre, region.radius};
  double sum = 0;
  visit_contacts(scene, state, [&](const ContactPoint& c) {
    const Vec3 from = state.grains.position[c.i].vec();
    sum += share_inside(from, from + c.branch, sphere) * dot(c.force(), along) * dot(c.branch, along);
  });
  return sum / grain_volume(state.dimension, region.radius);
}

/// Looks into the region, and once the boundary has the stress that it aims at, moves that aim by a part of what the
/// region lacks. Slow against the servo itself, whose proof of stability stays.
void correct_target(const Scene& scene, State& state, const BodyDrive& drive, double excess, double target) {
  Body& body = state.bodies[drive.body];
  body.inside = stress_inside(scene, state, *drive.region, drive.along);
  if (std::abs(excess) > near_target * target) return;
  body.correction = std::clamp(body.correction + region_gain * (drive.target - body.inside),
                               -most_correction * drive.target, most_correction * drive.target);
}

double longest_edge(const State& state) {
  double length = 0;
  for (int k = 0; k < state.dimension; ++k) length = std::max(length, state.cell.h(k, k));
  return length;
}

/// A servo that nothing holds against would go on for ever.
void check_way(const Scene& scene, const State& state, const BodyDrive& drive) {
  const Body& body = state.bodies[drive.body];
  const double way = drive.radial ? body.opened : dot(body.moved, drive.along), most = runaway * longest_edge(state);
  if (std::abs(way) > most)
    throw RunError(
        fmt::format("step {}: the servo of {} runs away: moved by {:.4g} m, more than {:g} times the specimen's "
                    "longest edge; see that walls hold the specimen on all other sides and that the target can be met",
                    state.step, scene.boundary.bodies[drive.body].name, std::abs(way), runaway));
}

/// Speed at which the specimen strains with the inertial number of slow tests.
double default_speed(const Scene& scene, const State& state, const BodyDrive& drive) {
  const double length = longest_edge(state);
  const double area = body_load(scene, state, drive).area;
  const double target = drive.servo == Servo::stress || std::isnan(area) ? drive.target : drive.target / area;
  return slow_enough * length / size_statistics(state).d50 *
         std::sqrt(std::max(target, 1.0) / scene.materials.front().density);
}

}  // namespace

BodyDrive drive_of(const Scene& scene, const State& state, std::size_t body) {
  if (state.stage < scene.stages.size())
    for (const auto& drive : scene.stages[state.stage].bodies)
      if (drive.body == body) return drive;
  BodyDrive at_rest;
  at_rest.body = body;
  at_rest.velocity = scene.boundary.bodies[body].velocity;
  return at_rest;
}

BodyLoad body_load(const Scene& scene, const State& state, const BodyDrive& drive) {
  const Body& body = state.bodies[drive.body];
  const Wall* plane = wall_of(state, drive.body, Wall::plane);
  const Wall* cylinder = wall_of(state, drive.body, Wall::cylinder);
  BodyLoad load;
  const bool radial = drive.radial || (drive.servo == Servo::none && !plane && cylinder);
  if (radial) {
    load.force = cylinder->hollow ? body.spread : -body.spread;
    load.area = round_area(scene, state, drive.body);
  } else if (drive.servo != Servo::none || plane) {
    const Vec3 along = drive.servo != Servo::none ? drive.along : -plane->normal;
    load.force = dot(body.force, along);
    set_flat_area(state, along, load);
  }
  if (const double given = scene.boundary.bodies[drive.body].area; !std::isnan(given)) load.area = given, load.bias = 0;
  return load;
}

double outer_stress(const Scene& scene, const State& state, std::size_t body) {
  const Wall* plane = wall_of(state, body, Wall::plane);
  const int axis = plane ? main_axis(plane->normal) : -1;
  if (axis < 0 || !(state.membrane.volume > 0)) return not_given;
  double section = 1;
  for (int k = 0; k < state.dimension; ++k) {
    if (k == axis) continue;
    Extent width{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (const Quad& p : state.grains.position)
      width = {std::min(width.low, p.vec()[k] - p.w), std::max(width.high, p.vec()[k] + p.w)};
    section *= width.length();
  }
  const BodyLoad load = body_load(scene, state, drive_of(scene, state, body));
  return state.membrane.stress + (load.stress() - state.membrane.stress) * load.area / section;
}

BodyControl::BodyControl(const Scene& scene, const State& state) : scene_(scene) {
  for (std::size_t b = 0; b < state.bodies.size(); ++b) {
    BodyDrive drive = drive_of(scene, state, b);
    if (drive.servo == Servo::stress && !(body_load(scene, state, drive).area > 0))
      throw input_error(scene.file, 0, fmt::format("stage.body.{}.stress", scene.boundary.bodies[b].name),
                        "needs the area that it acts on, which the walls do not tell",
                        fmt::format("give [boundary.body.{}] area, or aim at a force", scene.boundary.bodies[b].name));
    if (drive.servo != Servo::none && std::isnan(drive.max_speed)) drive.max_speed = default_speed(scene, state, drive);
    drives_.push_back(drive);
  }
}

void BodyControl::drive(State& state, double dt) const {
  for (const auto& d : drives_) {
    Body& body = state.bodies[d.body];
    for (int k = 0; k < 3; ++k)
      if (!d.free[static_cast<std::size_t>(k)]) body.velocity[k] = d.velocity[k];
    body.opening = d.opening;
    if (d.servo == Servo::none) continue;
    check_way(scene_, state, d);
    const double target = target_force(scene_, state, d), excess = body_load(scene_, state, d).force - target;
    if (d.region && state.stage_step % region_steps == 0) correct_target(scene_, state, d, excess, target);
    const bool touched = body.stiffness > 0;
    const double at_once = touched ? gain * excess / (body.stiffness * dt) : excess < 0 ? -d.max_speed : 0.0;
    const bool met = body.follow != 0 || std::abs(excess) < near_target * target;  // since the stage began
    body.follow = touched && met ? std::clamp(body.follow + at_once / patience, -d.max_speed, d.max_speed) : 0.0;
    // The specimen's own motion carries on when the servo stops, so it comes to its target slowly.
    const double most = d.max_speed * (met ? 1 : std::min(1.0, std::abs(excess / (ease * target))));
    const double speed = std::clamp(at_once + body.follow, -most, most);  // outward
    if (d.radial)
      body.opening = wall_of(state, d.body, Wall::cylinder)->hollow ? speed : -speed;
    else
      body.velocity += speed * d.along;
  }
}

/// Stored between grains and walls, and in the motion of bodies [J].
static double energy_beside_grains(const Scene& scene, const State& state) {
  double sum = 0;
  visit_contacts(scene, state, [&](const ContactPoint& p) { sum += p.j == no_index ? p.normal_energy : 0; });
  for (const auto& b : state.bodies)
    for (int k = 0; k < 3; ++k)
      sum += b.free[static_cast<std::size_t>(k)] ? 0.5 * b.mass * b.velocity[k] * b.velocity[k] : 0;
  return sum;
}

/// Takes away all surfaces of these bodies.
static void remove_walls(const std::vector<std::size_t>& bodies, State& state) {
  std::vector<Index> renumbered;
  std::vector<Wall> kept;
  for (const Wall& wall : state.walls) {
    const bool gone = std::ranges::find(bodies, wall.body) != bodies.end();
    renumbered.push_back(gone ? no_index : static_cast<Index>(kept.size()));
    if (!gone) kept.push_back(wall);
  }
  state.walls = std::move(kept);
  std::erase_if(state.wall_contacts, [&](const WallContact& c) { return renumbered[c.wall] == no_index; });
  for (auto& c : state.wall_contacts) c.wall = renumbered[c.wall];
  for (const std::size_t b : bodies) state.bodies[b] = Body{};
}

void begin_body_stage(const Scene& scene, State& state) {
  if (const auto& removed = scene.stages[state.stage].removed; !removed.empty()) {
    const double before = scene.energy ? energy_beside_grains(scene, state) : 0;
    remove_walls(removed, state);
    if (scene.energy) state.ledger.boundary += energy_beside_grains(scene, state) - before;  // it goes with them
  }
  for (std::size_t b = 0; b < state.bodies.size(); ++b) {
    Body& body = state.bodies[b];
    const BodyDrive drive = drive_of(scene, state, b);
    body.moved = {}, body.opened = 0, body.follow = 0;
    body.inside = body.correction = 0;
    for (int k = 0; k < 3; ++k)
      if (!drive.free[static_cast<std::size_t>(k)]) body.velocity[k] = drive.velocity[k];
    body.free = drive.free;
    body.yields = drive.servo != Servo::none || drive.free != std::array<bool, 3>{};
  }
}

void glue_grains(State& state, const std::vector<std::size_t>& glue) {
  for (const auto& contact : state.wall_contacts) {
    const Wall& wall = state.walls[contact.wall];
    Quad& v = state.grains.velocity[contact.grain];
    const Quad& p = state.grains.position[contact.grain];
    if (v.w == 0 || std::ranges::find(glue, wall.body) == glue.end()) continue;
    if (!(grain_wall(state, wall, p.vec(), p.w, Arms::middle).overlap > 0)) continue;
    v.w = 0;
    if (state.grains.rotates()) state.grains.spin[contact.grain] = Quad{};
    state.glued.push_back({contact.grain, wall.body});
  }
  std::ranges::sort(state.glued, {}, &GluedGrain::grain);
}

double body_step_limit(const State& state) {
  double limit = std::numeric_limits<double>::infinity();
  for (const auto& body : state.bodies)
    if (body.free != std::array<bool, 3>{} && body.stiffness > 0)
      limit = std::min(limit, std::sqrt(body.mass / body.stiffness));
  return limit;
}

double servo_error(const Scene& scene, const State& state) {
  double worst = 0;
  for (std::size_t b = 0; b < state.bodies.size(); ++b) {
    const BodyDrive drive = drive_of(scene, state, b);
    if (drive.servo == Servo::none) continue;
    const double target = target_force(scene, state, drive), force = body_load(scene, state, drive).force;
    worst = std::max(worst, std::abs(force - target) / std::max(std::abs(target), 1e-300));
    if (drive.region) worst = std::max(worst, std::abs(state.bodies[b].inside / drive.target - 1));
  }
  return worst;
}

double largest_displacement(const State& state) {
  double most = 0;
  for (const auto& body : state.bodies) most = std::max({most, norm(body.moved), std::abs(body.opened)});
  return most;
}

}  // namespace eg
