#pragma once
// What is given: a validated scene, never changed during a run. SI units; compressive stress and strain positive.
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "base/vec.hpp"
#include "contact/material.hpp"

namespace eg {

inline constexpr double not_given = std::numeric_limits<double>::quiet_NaN();

/// [[contact.pair]]: what two materials have together and neither of them tells.
struct PairSpec {
  std::string first, second;  ///< names of [material.*]
  double friction = 0;        ///< µ [-]
};

/// [contact]
struct ContactSpec {
  std::string law = "hertz-mindlin";  ///< a name of contact/laws.hpp
  std::string arms = "overlap";       ///< "overlap": a = R − δ/2 (default); "radius": a = R, as LAMMPS gran/*
  std::vector<PairSpec> pairs;
  double friction_deviation = 0;   ///< standard deviation of µ over its mean [-]
  bool friction_by_grain = false;  ///< a µ for each grain, the smaller one counts; else one for each contact
};

/// Sizes of grains. [specimen] grading = …
struct Grading {
  enum class Kind { single, uniform, table };
  Kind kind = Kind::single;
  double min_radius = 0, max_radius = 0;       ///< [m], single: both the same; uniform: by number
  std::vector<std::array<double, 2>> passing;  ///< table: {diameter [m], passing by mass [0..1]}, ascending
  bool gap = false;                            ///< table of two ranges, fines and coarse grains, with nothing between

  void scale(double factor) {  ///< of all sizes
    min_radius *= factor, max_radius *= factor;
    for (auto& [diameter, share] : passing) diameter *= factor;
  }
};

/// What is left of a packing: the grains inside a box, or inside a cylinder along an axis, solid or hollow.
struct TrimSpec {
  enum class Shape { box, cylinder };
  enum class Keep { whole, centre };  ///< grains that lie inside as a whole, or with their centre
  Shape shape = Shape::box;
  Keep keep = Keep::whole;
  Vec3 low{-unbounded, -unbounded, -unbounded}, high{unbounded, unbounded, unbounded};  ///< around the shape [m]
  int axis = 2;                                                                         ///< of a cylinder; 2D: 2
  Vec3 centre;              ///< a point of the cylinder's axis [m]
  double radius = 0;        ///< of a cylinder [m]
  double inner_radius = 0;  ///< of a hole along its axis [m]

 private:
  static constexpr double unbounded = std::numeric_limits<double>::infinity();
};

/// [specimen]
struct SpecimenSpec {
  enum class Source { lattice, cloud, file };
  Source source = Source::cloud;
  // lattice
  std::string lattice;                ///< a name of specimen/lattice.hpp: "fcc", "hexagonal"
  std::array<int, 3> cells{4, 4, 4};  ///< conventional (rectangular) unit cells along x, y, z
  double radius = not_given;          ///< [m]
  double overlap = 0;                 ///< δ/d of touching neighbours, d = 2R [-]
  double pressure = not_given;  ///< instead of overlap: isotropic pressure that the lattice carries [Pa] (2D: N/m)
  double radius_scatter = 0;    ///< standard deviation over mean radius [-], normal, cut at ±3 SD
  // cloud
  std::size_t count = 0;
  std::size_t coarse_count = 0;  ///< instead of count, gap gradings: of the coarse grains
  Grading grading;
  double solid_fraction = 0.3;            ///< of the cloud, before any compression
  double expand_to = not_given;           ///< solid fraction of the same box once radii have grown to their sizes
  std::array<double, 3> aspect{1, 1, 1};  ///< edges of the box relative to x
  Vec3 box;                               ///< edges of the box [m], instead of the two above; 0: not given
  // file
  std::string path;  ///< packing text, or snapshot (.h5), relative to the scene file
  // any of them
  std::optional<TrimSpec> trim;

  /// Radii to begin with over those of the grading: below 1 where a stage lets them grow.
  double first_size(int dimension) const {
    return std::isnan(expand_to) ? 1.0 : std::pow(solid_fraction / expand_to, 1.0 / dimension);
  }
};

/// [[boundary.wall]], one surface.
struct WallSpec {
  enum class Shape { plane, cylinder };
  std::string name;
  Shape shape = Shape::plane;
  Vec3 point, normal;         ///< [m]; plane: unit, grains lie on this side; cylinder: unit, along its axis
  double radius = not_given;  ///< cylinder [m]
  bool hollow = true;         ///< cylinder: grains are inside
  /// Cylinder: height [m] (NaN: between planes across its axis) and angle [rad] of the part that grains press on, for
  /// stresses and volumes.
  double height = not_given, angle = 2 * std::numbers::pi;
  Vec3 along;  ///< unit; only grains whose centre has low ≤ (x − point)·along < high feel the wall
  std::array<double, 2> window{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  std::string material;  ///< a name of [material.*]
  std::size_t body = 0;  ///< of BoundarySpec::bodies
};

/// [[boundary.mesh]], triangles from an STL file.
struct MeshSpec {
  std::string path;      ///< as written in the scene; relative to the scene file
  double scale = 1;      ///< metres in a unit of the file
  Vec3 offset;           ///< [m], added after scaling
  bool hollow = false;   ///< grains are on the inner side of facets that turn counter-clockwise seen from outside
  bool open = false;     ///< edges may have one facet only
  std::string material;  ///< a name of [material.*]
  std::size_t body = 0;
  std::vector<std::array<Vec3, 3>> facets;  ///< corners [m], scaled and shifted; read with the scene file
};

/// A part of the apparatus that walls and meshes belong to.
struct BodySpec {
  std::string name, group;  ///< group: the stack of rings it is of, or empty
  Vec3 velocity;            ///< [m/s], in stages that do not drive it
  double mass = not_given;  ///< [kg] of a body that moves freely; default: its share of the grains
  std::string material;     ///< of a plane of the box; empty: BoundarySpec::wall_material
  double area = not_given;  ///< on which it loads grains [m²] (2D: m); default: worked out from the walls
};

/// [boundary.membrane], around what planes do not cover.
struct MembraneSpec {
  double probe = not_given;  ///< radius [m] of the probe that finds its grains; default: mean radius, 2D half of it
};

/// Bodies of the planes of a box: x_low, x_high, y_low, …
std::vector<BodySpec> box_bodies(int dimension);

/// [boundary]
struct BoundarySpec {
  enum class Kind { periodic, free, box };
  Kind kind = Kind::periodic;    ///< box: the six (2D: four) planes of the specimen's box become walls
  std::string wall_material;     ///< box only
  std::vector<BodySpec> bodies;  ///< box: x_low, x_high, y_low, … first
  std::vector<WallSpec> walls;   ///< further walls: [[boundary.wall]], [[boundary.rings]]
  std::vector<MeshSpec> meshes;
  std::optional<MembraneSpec> membrane;
};

/// [damping]
struct DampingSpec {
  double local = 0;         ///< α [-]: −α|F| sign(v), moments too
  double mass = 0;          ///< [1/s]: −c m v, −c I ω
  double normal_ratio = 0;  ///< ξn [-]: contact dashpot 2ξn√(m* kn)
  double shear_ratio = 0;   ///< ξs [-]: contact dashpot 2ξs√(m* kt)

  bool dashpots() const { return normal_ratio > 0 || shear_ratio > 0; }
  bool any() const { return local > 0 || mass > 0 || dashpots(); }
};

/// [timestep]
struct TimestepSpec {
  std::string policy = "certified";  ///< "certified", "fixed" or "estimate:NAME"
  double fixed = not_given;          ///< [s], policy fixed
  double safety = 0.9;               ///< fraction of the certified step
};

/// How one strain component of the periodic cell is driven.
struct ComponentControl {
  enum class Kind { rate, inertial, stress, free };
  Kind kind = Kind::rate;
  /// rate: strain rate [1/s]; inertial: the rate's inertial number I = ε̇ d50 √(ρ/p) [-], its sign that of the rate;
  /// stress: target [Pa] (2D: N/m); free: not read, conditions of StageSpec::hold decide. Compression positive.
  double value = 0;
};

/// Σ coefficient · strain rate = value [1/s], or Σ coefficient · stress = value [Pa] (2D: N/m).
struct CellCondition {
  enum class Quantity { rate, stress };
  Quantity quantity = Quantity::rate;
  std::array<double, 6> coefficient{};  ///< of x y z yz xz xy
  double value = 0;
};

/// Back and forth between two limits: the rates of the stage turn around there.
struct CycleSpec {
  enum class Quantity { strain, stress };
  Quantity quantity = Quantity::strain;
  std::array<double, 6> coefficient{};  ///< of x y z yz xz xy; the quantity is their weighted sum
  double mean = 0, amplitude = 0;       ///< [-] or [Pa] (2D: N/m)
  double largest_strain = std::numeric_limits<double>::infinity();  ///< of any component: the stage ends there [-]
};

/// A sphere (2D: circle) inside the specimen whose mean stress a servo aims at.
struct ServoRegion {
  Vec3 centre;        ///< [m]
  double radius = 0;  ///< [m]
};

/// [stage.body.NAME]: how a body moves during a stage. Bodies without an entry move with BodySpec::velocity.
struct BodyDrive {
  enum class Servo { none, force, stress };
  std::size_t body = 0;
  Vec3 velocity;       ///< [m/s]
  double opening = 0;  ///< rate at which the radius of its cylinders grows [m/s]
  Servo servo = Servo::none;
  double target = 0;    ///< [N], or [Pa] (2D: N/m) on the loaded area; of the grains on the body, along `along`
  Vec3 along;           ///< unit, out of the specimen; not read when radial
  bool radial = false;  ///< the radius answers
  std::optional<ServoRegion> region;  ///< the target is the stress there along `along`, not that on the boundary
  double max_speed = not_given;       ///< of the servo [m/s]; default: so that the inertial number stays below 2.5e-3
  std::array<bool, 3> free{};         ///< axes along which the forces of the grains accelerate it
};

/// Bonds made at the beginning of a stage.
struct BondSpec {
  double gap = 0;            ///< between all grains nearer than this [m]
  std::size_t clusters = 0;  ///< only within so many clusters of grains; 0: between all
};

/// Friction that falls, from StageSpec::friction on, while the packing is at rest, until one of these is met.
struct FrictionSchedule {
  double void_ratio = not_given;   ///< [-]
  double mean_stress = not_given;  ///< [Pa] (2D: N/m)
};

/// The apparatus is shaken: it moves by s = −a/(2πf)² (1 − cos 2πft), so that grains seen from it feel a further
/// acceleration a cos 2πft, which is how it is computed.
struct ShakeSpec {
  Vec3 acceleration;     ///< a [m/s²]
  double frequency = 0;  ///< f [Hz]
};

/// [[stage]]
struct StageSpec {
  std::string name;
  std::optional<BondSpec> bond;
  std::optional<double> friction;                        ///< replaces every material's friction during this stage …
  std::vector<std::optional<double>> material_friction;  ///< … or that of some (by their place in Scene::materials)
  std::optional<FrictionSchedule> friction_schedule;
  double radius_growth = 0;             ///< of all radii until they have the sizes of the grading [1/s]
  std::optional<double> local_damping;  ///< replaces damping.local during this stage
  std::optional<ShakeSpec> shake;
  double held_above = not_given;  ///< grains whose centre is higher than this (z; 2D: y) stay where they are [m]
  // strain: axes x, y, z, then yz, xz, xy (engineering shear rate, for a cell with tilt)
  std::array<ComponentControl, 6> control{};
  std::vector<CellCondition> hold;  ///< as many as components are free
  std::optional<CycleSpec> cycle;
  std::vector<BodyDrive> bodies;
  std::vector<std::size_t> glue;     ///< bodies to which the grains that touch them are glued as the stage begins
  std::vector<std::size_t> removed;  ///< bodies whose walls are taken away as the stage begins
  double membrane_stress = 0;        ///< [Pa] (2D: N/m)
  double max_strain_rate =
      not_given;  ///< cap of what answers stresses [1/s]; default: 10, or ten times the rates driven
  // until (all that are given must hold; time/steps/strain end the stage by themselves)
  double until_stress_error = not_given;  ///< |σ − target|/target [-]
  double until_unbalanced = not_given;    ///< mean unbalanced force over mean contact force [-]
  double until_time = not_given;          ///< [s], since the stage began
  double until_steps = not_given;         ///< since the stage began
  double until_axial_strain = not_given;  ///< |εz| (2D: |εy|) since the stage began [-]
  double until_shear_strain = not_given;  ///< largest |γ| since the stage began [-]
  double until_cycles = not_given;
  double until_displacement = not_given;  ///< largest way of a body (or growth of a radius) since the stage began [m]
  double max_steps = 5e6;                 ///< a stage that has not ended by then stops the run with an error
  // record
  double record_every_steps = not_given;  ///< default: 1000, unless by strain
  double record_every_strain = not_given;
  double record_every_displacement = not_given;  ///< [m]
  double snapshot_every_steps = not_given;
  double snapshot_every_displacement = not_given;  ///< [m]
  bool snapshot_at_end = false;                    ///< of the stage, under its name
};

struct Scene {
  std::string title = "untitled";
  std::string file = "<memory>";  ///< where it was read, for messages and relative paths
  std::string text;               ///< the whole file, kept in every snapshot
  int dimension = 3;
  bool rotation = true;  ///< false: grains never turn (no rotational degrees of freedom anywhere)
  std::uint64_t seed = 1;
  std::vector<Material> materials;  ///< the first one is the grains' unless stated
  ContactSpec contact;
  SpecimenSpec specimen;
  BoundarySpec boundary;
  DampingSpec damping;
  TimestepSpec timestep;
  Vec3 gravity;         ///< [m/s²]
  bool energy = false;  ///< [record] energy: keep the energy ledger
  std::vector<StageSpec> stages;
};

}  // namespace eg
