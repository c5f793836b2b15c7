#pragma once
// Regular packings of equal grains. Every lattice is cut into rectangular conventional cells whose edges are multiples
// of the centre distance b of touching neighbours:
//
//   name       cell edges / b           grains  Z    solid fraction at touch
//   sc         1, 1, 1                  1       6    π/6
//   bcc        2/√3, 2/√3, 2/√3         2       8    π√3/8
//   fcc        √2, √2, √2               4       12   π/(3√2)
//   fcc-110    1, 1, √2                 2       12   π/(3√2)    fcc turned: rows along x and y, square layers
//   horizontal fcc-111    1, √3, √6                6       12   π/(3√2)    fcc turned: close-packed layers horizontal,
//   rows along x hcp        1, √3, 2√(2/3)           4       12   π/(3√2)    close-packed layers horizontal, rows along
//   x square     1, 1                     1       4    π/4 hexagonal  1, √3                    2       6    π/(2√3)
//   rows along x
#include <array>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/random.hpp"
#include "state/packing.hpp"

namespace eg {

struct LatticeCell {
  int dimension;
  int coordination;         ///< Z, touching neighbours of a grain
  Vec3 edges;               ///< over b [-]; 2D: edges.z = 0
  std::vector<Vec3> sites;  ///< fractional, centred in the cell

  /// Volume of a grain's share of the cell over b³ (2D: area over b²).
  double volume_per_grain() const;
};

/// By name (see above); nothing when there is no such lattice.
std::optional<LatticeCell> find_lattice(std::string_view name);
std::vector<std::string> lattice_names();

/// Normal force [N] of two equal grains of this radius [m] at this overlap δ [m] ≥ 0; rising with δ.
using NormalForce = std::function<double(double radius, double overlap)>;

/// Largest overlap δ/d a lattice is made with: beyond it second neighbours come near and no contact law holds.
inline constexpr double largest_lattice_overlap = 0.1;

/// Isotropic pressure that the lattice carries at relative overlap δ/d [Pa] (2D: N/m), compression positive:
/// p = Z N b/(6 V) in 3D, Z N b/(4 A) in 2D, V or A the share of one grain, b = d(1 − δ/d).
double lattice_pressure(const LatticeCell&, double radius, double relative_overlap, const NormalForce&);

/// The inverse: δ/d at which the lattice carries `pressure` > 0, to round-off. Nothing when that is more than
/// largest_lattice_overlap.
std::optional<double> lattice_overlap(const LatticeCell&, double radius, double pressure, const NormalForce&);

struct LatticeSize {
  std::array<int, 3> cells{1, 1, 1};  ///< conventional cells along x, y, z (z is not read in 2D), ≥ 1
  double radius = 0;                  ///< R [m], mean
  double relative_overlap = 0;        ///< δ/d of touching neighbours [-], at most largest_lattice_overlap; < 0: a gap
  double radius_scatter = 0;          ///< standard deviation over mean radius [-], in [0, 1/3)
  bool periodic = true;               ///< false: the box just touches the outermost grains
};

/// Centres stay on the lattice when radii scatter (normal, cut at ±3 SD by drawing again); the spacing is then that of
/// the largest grain drawn, so no pair overlaps by more than `relative_overlap` of its mean diameter.
Packing make_lattice(const LatticeCell&, const LatticeSize&, Random&);

}  // namespace eg
