#pragma once
// Rigid boundaries. A wall is one surface; a body is what moves and is weighed as one: a platen, half a shear box, a
// ring.
#include <array>
#include <cstdint>
#include <limits>
#include <numbers>

#include "base/vec.hpp"

namespace eg {

struct Body {
  Vec3 velocity;         ///< [m/s]
  double opening = 0;    ///< rate at which the radius of its cylinders grows [m/s]
  Vec3 force;            ///< of the grains on it in the last step [N]
  double spread = 0;     ///< Σ of the forces on its cylinders along their radius, outward positive [N]
  double magnitude = 0;  ///< Σ |f| of its contacts [N]
  double stiffness = 0;  ///< Σ max(kn, kt) of its contacts, those of glued grains as they were last weighed [N/m]
  double glued_stiffness = 0;  ///< share of glued grains in it [N/m]
  Vec3 moved;                  ///< since the stage began [m]
  double opened = 0;           ///< growth of the radius since the stage began [m]
  double mass = 0;             ///< [kg], of a body that some stage sets free
  std::array<bool, 3> free{};  ///< axes along which it goes where forces take it
  double follow = 0;           ///< part of a servo's speed that has built up, outward [m/s]
  double inside = 0;           ///< stress in a servo's region when it last looked [Pa]
  double correction = 0;       ///< what is added to the target on the boundary for the sake of that region [Pa]
  bool yields = false;         ///< it answers the forces on it: free along an axis, or driven by a servo
};

/// A surface that grains cannot cross. A mesh is made of faces, and of the rims and tips that stand out towards the
/// grains: each contact with it belongs to exactly one of them.
struct Wall {
  static constexpr std::uint8_t plane = 0, cylinder = 1, face = 2, rim = 3, tip = 4;
  std::uint8_t shape = plane;
  Vec3 point;          ///< on the plane; on the axis; first corner of the face; one end of the rim; the tip [m]
  Vec3 normal;         ///< unit: plane, face: towards the grains; cylinder, rim: along it
  double radius = 0;   ///< cylinder [m]
  bool hollow = true;  ///< cylinder: grains are inside
  double angle = 2 * std::numbers::pi;  ///< cylinder: of the part that grains press on [rad]
  Vec3 side_b, side_c;     ///< face: to its other corners [m]; rim: unit vectors into its faces, across it (0: no face)
  double length = 0;       ///< rim [m]
  std::uint8_t owned = 0;  ///< face: bits 0–2: a grain exactly over edge ab, bc, ca is its own
  Index spoke = 0, spokes = 0;  ///< tip: where its edges begin in State::spokes, and how many they are
  /// It is there for grains whose centre has low ≤ (x − point)·along < high; beside that, its ledge and corner are.
  Vec3 along;
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();  ///< [m]
  Index body = 0;
  std::uint16_t material = 0;
  double moved = 0;  ///< bound of the path since contacts were last refreshed [m]

  bool windowed() const {
    return low > -std::numeric_limits<double>::infinity() || high < std::numeric_limits<double>::infinity();
  }
};

struct WallContact {
  Index grain = 0, wall = 0;
  std::array<double, 16> history{};  ///< as Contacts::history, seen from the grain as i and the wall as j
  double friction = 1;               ///< factor on µ
};

/// A grain that moves with a body and does not turn. Its mass is taken as infinite.
struct GluedGrain {
  Index grain = 0, body = 0;
};

}  // namespace eg
