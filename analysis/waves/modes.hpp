#pragma once
// Vibration modes of a packing, every contact sticking: K x = ω² M x.
//
// Lowest, highest or all within a window by shift-invert; how many there must be is counted by the signs of the pivots
// of A − σ = L D Lᵀ (Sylvester's law of inertia), so that none is missed. Motions without any stiffness – a packing's
// rigid translations, rattlers, rotations without friction – are no modes but are counted.
#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "assembly/network.hpp"

namespace eg {

struct Mode {
  double square = 0;         ///< ω² [1/s²]
  double residual = 0;       ///< ‖Ax − ω²x‖ [1/s²], A = M^−½KM^−½, ‖x‖ = 1
  double participation = 0;  ///< 1/(N Σ p²), p the share of a grain in the kinetic energy: 1 when all move alike
  double rotation = 0;       ///< share of the kinetic energy in rotation

  double frequency() const;  ///< ω/2π [Hz]
};

struct ModeSet {
  std::vector<Mode> modes;          ///< slowest first
  Eigen::MatrixXd shapes;           ///< a column each: M^½ x, length 1; empty when only frequencies were wanted
  std::optional<std::size_t> zero;  ///< motions with ω below 1e-5 of the highest: not among the modes; lowest and all
  std::size_t total = 0;            ///< degrees of freedom that can move: modes and zero motions of the packing
  std::optional<bool>
      complete;  ///< the count by inertia agrees: none was missed. Not for all_modes(), nor above 60,000 rows
  std::string method;
};

/// The slowest modes above zero. Throws RunError when the factor does not fit into memory or nothing can vibrate.
ModeSet lowest_modes(const Network& network, std::size_t count);
/// The fastest modes; the last one is λmax of the time step.
ModeSet highest_modes(const Network& network, std::size_t count);
/// All modes with low ≤ f < high [Hz].
ModeSet modes_between(const Network& network, double low, double high);
/// Every mode by a dense solver, 8 rows² bytes (twice that with shapes), O(rows³).
ModeSet all_modes(const Network& network, bool with_shapes);

}  // namespace eg
