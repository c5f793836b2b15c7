#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace eg {

/// Constants of a solid, as the scene gives them. Which of them a law reads is that law's business; NaN = not given.
struct Material {
  static constexpr double unset = __builtin_nan("");
  std::string name = "grain";
  double density = unset;  ///< ρ [kg/m³]; 2D: of a disk of unit thickness
  double friction = 0;     ///< µ [-], Coulomb; the smaller of two materials governs a pair without a [[contact.pair]]
  double shear_modulus = unset;          ///< G [Pa], Hertz–Mindlin
  double poisson = unset;                ///< ν [-], Hertz–Mindlin
  double normal_stiffness = unset;       ///< kn [N/m], linear law
  double shear_stiffness = unset;        ///< ks [N/m], linear law
  double effective_modulus = unset;      ///< E* [Pa], linear law by deformability
  double stiffness_ratio = unset;        ///< k* = kn/ks [-], linear law by deformability
  double hertz_exponent = unset;         ///< α [-], of PFC's Hertz law N = h δ^α
  double roughness = unset;              ///< Sq [m], root mean square height of the surface
  double rolling_friction = unset;       ///< µr [-], largest rolling couple over R̄ N
  double bond_modulus = unset;           ///< Ē [Pa]
  double bond_stiffness_ratio = unset;   ///< κ̄ = k̄n/k̄s [-]
  double bond_radius_ratio = unset;      ///< λ [-], radius of the bond over that of the smaller grain
  double bond_moment_share = unset;      ///< β [-], share of the moments in the stress of the bond
  double bond_tensile_strength = unset;  ///< σc [Pa]
  double bond_shear_strength = unset;    ///< τc [Pa]
};

/// A constant of a material by its name in the scene file.
struct MaterialConstant {
  std::string_view key;
  double Material::*value;
};
/// Constants that a law can work from when all of them are given.
using ConstantSet = std::vector<MaterialConstant>;

}  // namespace eg
