#pragma once
// How a packing is strained. Every load is a jump e_c across each spring while the grains stand still: they then move
// so that the energy ½ Σ (Δ_c + e_c)ᵀ k_c (Δ_c + e_c) is least.
#include <array>
#include <functional>
#include <string>
#include <vector>

#include "assembly/network.hpp"

namespace eg {

struct LoadCases {
  std::vector<std::string> names;                  ///< "xx" …
  std::function<Vec3(const Spring&, int)> jump{};  ///< of a spring under a unit of a load [m]

  int count() const { return static_cast<int>(names.size()); }
};

/// Homogeneous strain of a periodic cell, in Voigt's order: e = ε·l n, l the length of the branch. Extension is
/// positive, shear strains are engineering ones.
LoadCases periodic_strains(int dimension);

/// Rigid walls across x, y, z, at the distances given (0: there is no pair), moved apart by a unit of strain, one
/// direction a load; walls are rough (they hold the grains that touch them) as far as the springs are. Needs springs of
/// walls along the axes.
LoadCases platen_strains(const std::array<double, 3>& distance);

}  // namespace eg
