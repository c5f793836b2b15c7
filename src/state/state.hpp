#pragma once
// What evolves: grains, contacts with their history, cell, walls. Enough of it is stored in a snapshot to go on bit for
// bit and to linearise. What is given stands in Scene, what is scratch in dynamics.
#include <array>
#include <cstdint>
#include <vector>

#include "base/vec.hpp"
#include "state/cell.hpp"

namespace eg {

/// Grains as quads. Arrays that a scene does not need stay empty (rotation, fixed, material).
struct Grains {
  std::vector<Quad> position;            ///< centre x, y, z [m]; w = radius [m]
  std::vector<Quad> velocity;            ///< peculiar velocity c = v − L·x [m/s]; w = 1/m [1/kg], 0 for a fixed grain
  std::vector<Quad> spin;                ///< angular velocity [rad/s]; w = 1/I [1/(kg m²)]; empty without rotation
  std::vector<Index> id;                 ///< the user's number; the order of grains changes (spatial sort), ids stay
  std::vector<std::uint16_t> material;   ///< index into Scene::materials; empty: all 0

  std::size_t size() const { return position.size(); }
  bool rotates() const { return !spin.empty(); }
  double radius(std::size_t i) const { return position[i].w; }
  std::uint16_t material_of(std::size_t i) const { return material.empty() ? std::uint16_t{0} : material[i]; }
};

/// Pairs that touch, or may touch before the next list update, with their history. Sorted by i, then j, then image.
/// The branch vector of a pair is x_j + cell.shift(image) − x_i; one pair may be i == j through an image of itself.
struct Contacts {
  static constexpr std::size_t lanes = 8;  ///< history is stored in blocks [value][lane] of eight contacts
  std::vector<Index> i, j;
  std::vector<std::uint8_t> image;       ///< code of Cell::shift; empty when no direction is periodic
  std::vector<double> history;           ///< history_size values a contact; first three are the shear vector [N] on i
  std::size_t history_size = 0;

  std::size_t size() const { return i.size(); }
  double& history_at(std::size_t c, std::size_t k) {
    return history[(c / lanes * history_size + k) * lanes + c % lanes];
  }
  double history_at(std::size_t c, std::size_t k) const {
    return history[(c / lanes * history_size + k) * lanes + c % lanes];
  }
  std::uint8_t image_of(std::size_t c) const { return image.empty() ? Cell::home : image[c]; }
  /// Resizes to n contacts; history of new contacts is zero.
  void resize(std::size_t n, bool periodic) {
    i.resize(n), j.resize(n);
    image.resize(periodic ? n : 0);
    history.resize((n + lanes - 1) / lanes * lanes * history_size);
  }
};

/// A plane that grains cannot cross; they lie on the side of its normal.
struct Wall {
  Vec3 point, normal;                    ///< [m], unit
  Vec3 velocity;                         ///< [m/s]
  std::uint16_t material = 0;
  Vec3 force;                            ///< force of the grains on the wall in the last step [N]
  double work = 0;                       ///< work done by the wall on the grains so far [J]
};

struct WallContact {
  Index grain = 0, wall = 0;
  std::array<double, 8> history{};       ///< as Contacts::history, seen from the grain as i and the wall as j
};

/// Work and dissipation so far [J] (2D: per metre of thickness). Kept only when Scene::energy.
struct EnergyLedger {
  double shear_work = 0;        ///< work put into tangential springs and sliders (elastic + friction + path dependence)
  double friction = 0;          ///< dissipated by sliding
  double local_damping = 0, mass_damping = 0, viscous_damping = 0;  ///< dissipated
  double boundary = 0;          ///< work done on the grains by the cell and the walls
  double body = 0;              ///< work done by gravity
};

struct State {
  int dimension = 3;
  double time = 0;              ///< [s]
  std::uint64_t step = 0;
  double dt = 0;                ///< step that led here [s]; velocities belong to time − dt/2
  Cell cell;
  Grains grains;
  Contacts contacts;
  std::vector<Wall> walls;
  std::vector<WallContact> wall_contacts;
  EnergyLedger ledger;
  std::vector<double> friction; ///< µ in force per material (a stage may have replaced the scene's)
  std::size_t stage = 0;        ///< stage under way, and the state it began from
  std::uint64_t stage_step = 0;
  double stage_time = 0;
  Mat3 stage_cell;              ///< cell matrix when the stage began
  std::array<double, 6> servo{};///< integral part of the cell controller [1/s]
};

}  // namespace eg
