#pragma once
// What evolves: grains, contacts with their history, cell, walls. Enough of it is stored in a snapshot to go on bit for
// bit and to linearise. What is given stands in Scene, what is scratch in dynamics.
#include <array>
#include <cstdint>
#include <vector>

#include "base/aligned.hpp"
#include "base/vec.hpp"
#include "state/cell.hpp"
#include "state/list.hpp"
#include "state/membrane.hpp"
#include "state/wall.hpp"

namespace eg {

/// Grains as quads. Arrays that a scene does not need stay empty (rotation, fixed, material).
struct Grains {
  std::vector<Quad> position;           ///< centre x, y, z [m]; w = radius [m]
  std::vector<Quad> velocity;           ///< peculiar velocity c = v − L·x [m/s]; w = 1/m [1/kg], 0 for a fixed grain
  std::vector<Quad> spin;               ///< angular velocity [rad/s]; w = 1/I [1/(kg m²)]; empty without rotation
  std::vector<Index> id;                ///< the user's number; the order of grains changes (spatial sort), ids stay
  std::vector<std::uint16_t> material;  ///< index into Scene::materials; empty: all 0

  std::size_t size() const { return position.size(); }
  bool rotates() const { return !spin.empty(); }
  double radius(std::size_t i) const { return position[i].w; }
  std::uint16_t material_of(std::size_t i) const { return material.empty() ? std::uint16_t{0} : material[i]; }
};

/// Pairs that touch, or may touch before the next refresh of the list, with their history. Sorted by i, then j, then
/// image. The branch vector of a pair is x_j + cell.shift(image) − x_i; one pair may be i == j through an image of
/// itself. Grains are taken in chunks of `chunk`; the contacts of a chunk (those whose i lies in it) are padded to
/// whole blocks of `lanes` by entries with i == j in the home image. Loop over contacts with is_padding() in mind.
struct Contacts {
  static constexpr std::size_t lanes = 8, chunk = 512;
  static constexpr std::size_t worth_threads = 8;  ///< chunks from which starting threads pays
  std::vector<Index> i, j;
  std::vector<std::uint8_t> image;  ///< code of Cell::shift; empty when no direction is periodic
  AlignedVector<double> history;    ///< blocks [value][lane] of eight contacts; vectors first (shear force on i [N])
  std::vector<double> friction;     ///< factor on µ, one a contact; empty where µ does not vary
  std::vector<std::uint64_t>
      chunk_begin;                  ///< contacts of chunk k: [chunk_begin[k], chunk_begin[k+1]), multiples of `lanes`
  std::size_t history_size = 0;     ///< values a contact, fixed by the law
  std::size_t history_vectors = 0;  ///< how many 3-vectors lead them
  std::size_t bond_value = 0;       ///< which value is > 0 while a bond holds; 0: a law without bonds
  std::size_t tail_vectors = 0;     ///< how many 3-vectors end them (dashpot force [N], only with an energy ledger)

  std::size_t size() const { return i.size(); }
  std::uint8_t image_of(std::size_t c) const { return image.empty() ? Cell::home : image[c]; }
  bool is_padding(std::size_t c) const { return i[c] == j[c] && image_of(c) == Cell::home; }
  double& history_at(std::size_t c, std::size_t k) {
    return history[(c / lanes * history_size + k) * lanes + c % lanes];
  }
  double history_at(std::size_t c, std::size_t k) const {
    return history[(c / lanes * history_size + k) * lanes + c % lanes];
  }
  bool is_bonded(std::size_t c) const { return bond_value > 0 && history_at(c, bond_value) > 0; }
};

/// How friction varies about the µ of a pair of materials (state/friction.hpp).
struct FrictionScatter {
  double deviation = 0;   ///< standard deviation over mean [-]; 0: none
  bool by_grain = false;  ///< of each grain, the smaller one of two counts; else of each contact
  std::uint64_t seed = 0;
};

/// Bonds since the beginning of the run.
struct BondCount {
  std::uint64_t made = 0, pulled = 0, cut = 0;  ///< made; broken by tension, by shear
};

/// Work and dissipation so far [J] (2D: per metre of thickness). Kept only when Scene::energy.
struct EnergyLedger {
  double shear_work = 0;  ///< work put into tangential springs and sliders (elastic + friction + path dependence)
  double friction = 0;    ///< dissipated by sliding
  double local_damping = 0, mass_damping = 0, viscous_damping = 0;  ///< dissipated
  double boundary = 0;  ///< work done on the grains, and on bodies that move freely, by the cell and the walls
  double body = 0;      ///< work done by gravity
};

/// A bound of λmax of the damped network that stands while contacts keep within what they are allowed
/// (timestep/standing_bound.hpp). `overlap` and `weight` have one value an entry of State::contacts, `wall_overlap` one
/// an entry of wall_contacts.
struct StandingBound {
  double value = 0;             ///< λmax ≤ value [1/s²]; 0: there is none
  double step = 0;              ///< at which dashpots are counted [s]
  std::vector<double> overlap;  ///< up to which a pair is counted [m]; 0: not at all, infinite for padding
  std::vector<double> weight;   ///< t of the pair, 0 where it was not counted
  std::vector<double> wall_overlap;
  std::vector<double> grain;  ///< bound of λmax(S_i) of every grain with all pairs at what they are allowed [1/s²]
  double usual = 0;           ///< half of what pairs are allowed on average [m]
};

/// What the step policy has planned; part of the state so that a resumed run goes on alike.
struct StepPlan {
  double dt = 0;                ///< step in force [s]; 0: none chosen yet
  double safe = 0;              ///< certified limit of the step [s]
  double unsafe = 0;            ///< the limit of the packing as it was at the last evaluation was not above this [s]
  int cause = 0;                ///< of the last evaluation, as the policy numbers them
  std::uint64_t made = 0;       ///< step of the last evaluation
  std::uint64_t due = 0;        ///< step of the next evaluation at the latest
  std::uint64_t check = 0;      ///< step of the next check that the bound still stands
  std::uint64_t ahead = 0;      ///< steps from one check to the next, at most
  std::uint64_t lifetime = 0;   ///< steps between evaluations when nothing happens
  double room = 0;              ///< how much larger than need be the bound was chosen [-]
  std::uint64_t refreshes = 0;  ///< of the lists that the bound is for
  StandingBound bound;
};

/// Where a stage with a cycle stands.
struct CycleProgress {
  double direction = 1;     ///< 1 or −1: sense of the stage's rates
  std::uint64_t turns = 0;  ///< limits reached so far
};

/// Where a stage stands that changes the grains themselves (dynamics/preparation.hpp).
struct Preparation {
  bool settled = false;    ///< friction schedule: the packing has come to rest at the friction it began with …
  bool met = false;        ///< … and has met the target since
  double size = 1;         ///< of radii, over that of the grading [-]
  double growth = 0;       ///< rate of all radii now [1/s]
  double grown_until = 0;  ///< stage time up to which they have grown [s]
};

struct State {
  int dimension = 3;
  double time = 0;  ///< [s]
  std::uint64_t step = 0;
  double dt = 0;  ///< step that led here [s]; velocities belong to time − dt/2
  Cell cell;
  Grains grains;
  Contacts contacts;
  NeighbourList list;
  std::vector<Body> bodies;
  std::vector<Wall> walls;
  std::vector<Vec3> spokes;  ///< unit vectors along the edges that meet in tips, tip after tip
  std::vector<WallContact> wall_contacts;
  std::vector<GluedGrain> glued;  ///< by grain
  Membrane membrane;
  std::vector<AppliedForce> applied;  ///< by grain
  Mat3 virial;               ///< Σ f ⊗ branch over contacts of the last step, f on j [J]; stress is virial/volume
  double stiffness_sum = 0;  ///< Σ kn d² over contacts of the last step [J]
  EnergyLedger ledger;
  std::vector<double> friction;  ///< µ in force of every pair of materials, row after row (state/friction.hpp)
  FrictionScatter friction_scatter;
  BondCount bonds;
  std::size_t stage = 0;  ///< stage under way, and the state it began from
  std::uint64_t stage_step = 0;
  double stage_time = 0;
  double unbalanced = 1;  ///< mean net force over mean contact force at the last check [-]
  double kinetic = 0;     ///< kinetic energy at the last check [J]
  StepPlan policy;
  std::array<double, 6> servo{};  ///< integral part of the cell controller, an equation each [1/s]
  CycleProgress cycle;
  Preparation preparation;
};

}  // namespace eg
