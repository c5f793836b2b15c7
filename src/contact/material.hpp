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
  double friction = 0;     ///< µ [-], Coulomb; the smaller of two materials governs a pair unless pairs say otherwise
  double shear_modulus = unset;      ///< G [Pa], Hertz–Mindlin
  double poisson = unset;            ///< ν [-], Hertz–Mindlin
  double normal_stiffness = unset;   ///< kn [N/m], linear law
  double shear_stiffness = unset;    ///< ks [N/m], linear law
  double effective_modulus = unset;  ///< E* [Pa], linear law by deformability
  double stiffness_ratio = unset;    ///< k* = kn/ks [-], linear law by deformability
};

/// A constant of a material by its name in the scene file.
struct MaterialConstant {
  std::string_view key;
  double Material::*value;
};
/// Constants that a law can work from when all of them are given.
using ConstantSet = std::vector<MaterialConstant>;

}  // namespace eg
