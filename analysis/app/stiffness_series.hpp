#pragma once
// Moduli of a packing at the end of every stage of its scene: how stiffness grows with stress.
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/prepare.hpp"
#include "report/plot.hpp"
#include "stiffness/relaxation.hpp"

namespace eg {

struct StiffnessOfStage {
  std::string stage;
  double mean_stress = 0;                            ///< p [Pa] (2D: N/m), compression positive
  double void_ratio = 0;                             ///< e [-]
  double coordination = 0;                           ///< Z [-]
  double bulk = 0, shear = 0;                        ///< K, G of the isotropic fit [Pa] (2D: N/m)
  double bulk_exponent = NAN, shear_exponent = NAN;  ///< d ln K/d ln p, d ln G/d ln p since the row before [-]
};

struct StiffnessSeries {
  std::string name, title;
  int dimension = 3;
  bool converged = true;
  std::vector<StiffnessOfStage> rows;
};

/// Runs the stages of a scene from its specimen. Periodic cells only: throws InputError for others, and for a scene
/// without stages.
StiffnessSeries stiffness_series(const std::string& name, const Scene& scene, State state,
                                 const RelaxationOptions& options);

std::string text_of(const StiffnessSeries& series);
nlohmann::json json_of(const StiffnessSeries& series);
/// K and G over p, both logarithmic, beside the slope 1/3 of smooth spheres.
Figure figure_of(const StiffnessSeries& series);
/// Throws RunError when the file cannot be written.
void write_tables(const StiffnessSeries& series, const std::string& path);

}  // namespace eg
