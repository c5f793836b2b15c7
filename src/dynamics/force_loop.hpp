#pragma once
// Forces of all contacts. The scene decides once which instantiation runs: law, friction, rotation, number type.
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "base/aligned.hpp"
#include "contact/interaction.hpp"
#include "state/scene.hpp"
#include "state/schedule.hpp"
#include "state/state.hpp"

namespace eg {

/// What the loop adds up over all contacts when asked.
struct Tally {
  Mat3 virial;                                       ///< Σ f ⊗ branch, f on j [J]
  double stiffness_sum = 0;                          ///< Σ kn d² [J]
  double force_sum = 0;                              ///< Σ |f| [N]
  double touching = 0;                               ///< number of contacts that touch
  double shear_work = 0, friction = 0, viscous = 0;  ///< work and dissipation of the last increment [J]
  double pulled = 0, cut = 0;                        ///< bonds broken in it by tension, by shear
  Tally& operator+=(const Tally& b);
};

/// Sums over grains of one kick. Works are exact for the discrete motion: F·(c₋ + c₊)/2 dt.
struct KickSums {
  double kinetic = 0;  ///< ½ Σ m c₋·c₊ + ½ Σ I ω₋·ω₊ at the time of the forces [J]
  double local_damping = 0, mass_damping = 0;  ///< dissipated [J]
  double body = 0;                             ///< work of gravity [J]
  double affine = 0;                           ///< work of the cell on peculiar motion, −m c·L·c dt [J]
  double unbalanced = 0;                       ///< Σ |net force| [N] over grains that can move
  KickSums& operator+=(const KickSums& b);
};

/// Scratch of the step: accumulator rows (grains, then halo rows) and their schedule. A row is a force [N], and
/// behind it a moment [N m] when grains turn.
struct ForceWorkspace {
  Schedule schedule;
  AlignedVector<Quad> rows;
  std::size_t stride = 2;    ///< quads a row: 2 with moments, else 1
  bool clean = false;        ///< rows are zero: the kick leaves them so, while they are at hand
  void clear();              ///< makes them so
  std::vector<Tally> tally;  ///< a chunk
  std::vector<KickSums> kick_sums;
  std::vector<Quad> shift;  ///< translation of each image
};

/// What the loop adds up: nothing, stress and stiffness, or works and force statistics too.
enum class TallyLevel { none, stress, works };

struct ForceOptions {
  Arms arms = Arms::middle;
  double normal_ratio = 0, shear_ratio = 0;  ///< contact dashpots, ξ
  TallyLevel tally = TallyLevel::none;
  bool viscous_history = false;  ///< dashpot work wanted: three values behind the law's history keep their force
  bool scalar = false;           ///< the reference path: one contact at a time
};

using AfterChunk = std::function<void(std::size_t chunk)>;

class ForceLoop {
 public:
  virtual ~ForceLoop() = default;
  virtual std::size_t history_size() const = 0;
  virtual std::size_t history_vectors() const = 0;
  virtual bool has_moments() const = 0;
  virtual std::size_t bond_value() const = 0;  ///< as Contacts::bond_value
  /// Makes a bond in the history of contact c at its present overlap [m]; nothing for a law without bonds.
  virtual void bond(Contacts& list, std::size_t c, double overlap) const = 0;
  /// Constants of all pairs of materials; `friction` as State::friction.
  virtual void set_materials(const std::vector<Material>& materials, const std::vector<double>& friction,
                             int dimension) = 0;
  /// Adds forces of all grain–grain contacts after an increment of length dt to workspace.rows, updates history.
  /// `after`, if any, is called once for each chunk as soon as all contacts of its grains are done, while they are at
  /// hand; it may change their velocities. Deterministic for any number of threads.
  virtual Tally contacts(State& state, ForceWorkspace& work, double dt, const ForceOptions& options,
                         const AfterChunk& after) const = 0;
  /// Adds the wall contacts, to the forces on bodies too.
  virtual Tally walls(State& state, ForceWorkspace& work, double dt, const ForceOptions& options) const = 0;
};

/// `frictionless` leaves out shear, its history and all moments. Throws InputError for an unknown law.
std::unique_ptr<ForceLoop> make_force_loop(std::string_view law, bool frictionless, bool rotation);

/// Sets sizes of the workspace after the contact list changed.
void prepare(ForceWorkspace& work, const State& state, const ForceLoop& loop);

/// Sum of contact forces and moments on one grain.
struct ForceRow {
  Vec3 force, moment;  ///< [N], [N m]
};

/// Of grain i, between contacts() and the kick: its own row plus its halo rows, in fixed order. Slow.
ForceRow gather_row(const ForceWorkspace& work, std::size_t i);

}  // namespace eg
