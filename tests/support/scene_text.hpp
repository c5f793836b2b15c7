#pragma once
// Beginnings of scene files that tests share.
#include <string>

namespace eg::test {

/// Quartz, the grains of most scenes; sections of the scene are to follow.
inline const std::string quartz = R"(
[material.quartz]
shear_modulus = 29e9
poisson = 0.12
density = 2650
friction = 0.25
)";

/// `count` soft frictional spheres of .8 to 1.2 mm in a cloud, with the energy ledger; sections of the boundary and the
/// stages are to follow.
inline std::string soft_grains(int count) {
  return R"(
dimension = 3
seed = 2
[material.grain]
normal_stiffness = 1e6
shear_stiffness = 7e5
density = 2650
friction = 0.3
[contact]
law = "linear"
[record]
energy = true
[specimen]
source = "cloud"
grading = { min_radius = 0.8e-3, max_radius = 1.2e-3 }
solid_fraction = 0.5
count = )" +
         std::to_string(count) + "\n";
}

}  // namespace eg::test
