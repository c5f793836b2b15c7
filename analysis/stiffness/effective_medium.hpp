#pragma once
// What theories of the mean field say of an isotropic packing of equal spheres, from numbers a laboratory has. All
// assume that every grain follows the mean strain, which makes K and G too large; for wide gradings the formulas from
// Z, φ and R can err either way.
#include "assembly/network.hpp"

namespace eg {

struct BulkShear {
  double bulk = 0, shear = 0;  ///< K, G [Pa]
};

/// A packing of spheres as mean-field theories see it.
struct MeanPacking {
  double coordination = 0;    ///< Z
  double solid_fraction = 0;  ///< φ
  double radius = 0;          ///< mean R [m]
};

/// K = Zφ kn/(6πR), G = Zφ (kn + 3/2 kt)/(10πR), from the mean stiffness of a contact [N/m].
BulkShear mean_field(const MeanPacking& packing, double normal_stiffness, double tangential_stiffness);

/// The same with the Hertz–Mindlin stiffness under the pressure p of grains with G and ν (Walton 1987). Rough: contacts
/// never slip; smooth: kt = 0.
BulkShear walton_rough(const MeanPacking& packing, double shear_modulus, double poisson, double pressure);
BulkShear walton_smooth(const MeanPacking& packing, double shear_modulus, double poisson, double pressure);

/// Digby (1981): contacts are bonded over a disk of radius b [m] before the pressure acts, and slip outside of it;
/// b = 0 gives Walton's smooth values.
BulkShear digby(const MeanPacking& packing, double shear_modulus, double poisson, double pressure, double bond_radius);

}  // namespace eg
