#pragma once
// What single grains, and grains of one size, carry of the stress.
#include <span>
#include <vector>

#include "state/gather.hpp"

namespace eg {

/// Σ f⊗a of every grain over its contacts, a the arm from its centre to the contact [J] (2D: J/m): the mean stress
/// inside the grain times its volume, compression positive. A branch is shared between its two grains as their arms, so
/// that all grains together give V σ of the packing.
std::vector<Mat3> grain_virials(std::size_t grains, std::span<const ContactPoint>);

/// A part of the grains: those with smallest ≤ diameter < largest.
struct SizeFraction {
  double smallest = 0, largest = 0;  ///< diameters [m]; 0 and infinity at the ends
  std::size_t grains = 0;
  double solid_share = 0;              ///< of the volume of all grains [-]
  double coordination = 0;             ///< mean number of contacts of these grains
  double mechanical_coordination = 0;  ///< of those with two contacts or more
  double rattler_share = 0;            ///< of these grains, with one contact or none
  Mat3 stress;                         ///< their part of the stress of the packing [Pa]; the parts add up to it
  double mean_stress_share = 0;        ///< their part of the mean stress [-]
  /// mean_stress_share/solid_share: mean stress in these grains over that in all; the α of Shire et al. (2014) when
  /// they are the fines.
  double stress_ratio = 0;
};

/// One fraction more than `splits` (diameters [m], ascending), finest first; `volume` of the packing.
std::vector<SizeFraction> size_fractions(const State&, std::span<const ContactPoint>, double volume,
                                         std::span<const double> splits);

/// Contacts by the fractions they join, as shares of the mean stress: share[a][b], a ≤ b; walls are left out of it.
std::vector<std::vector<double>> stress_by_pair(const State&, std::span<const ContactPoint>,
                                                std::span<const double> splits);

/// Diameters that split by mass into `parts` equal ones, or the middle of the widest gap (by ratio) of a gap-graded
/// packing: when neighbours in size differ by a factor of 1.5 or more. Fewer where sizes coincide.
std::vector<double> natural_splits(const State&, int parts = 4);

}  // namespace eg
