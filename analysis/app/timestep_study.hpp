#pragma once
// Where each rule of thumb for the time step fails: many packings, each with its proved interval and every rule.
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "report/plot.hpp"
#include "state/scene.hpp"
#include "timestep/estimates.hpp"
#include "timestep/interval.hpp"

namespace eg {

struct StudyRow {
  std::string packing;         ///< "two spheres", "random" or a lattice
  double pressure = 0;         ///< [Pa]; NaN where there is none
  double size_ratio = 1;       ///< largest over smallest radius
  double stiffness_ratio = 0;  ///< kt/kn
  double overlap = 0;          ///< largest, over the diameter of the smaller grain; NaN where there is none
  StepInterval interval;
  std::vector<Estimate> estimates;
};

/// The rows for a scene with a single-size cloud, a Hertz–Mindlin law and stages of isotropic stress. `note` hears what
/// is being made. Throws InputError when the scene is not such a one.
std::vector<StudyRow> timestep_study(const Scene& scene, const std::function<void(const std::string&)>& note);

/// A table of estimate over limit, cells above 1 marked as unstable; below it how far each rule goes wrong.
std::string text_of(const std::vector<StudyRow>& rows);
/// [{packing, pressure_Pa, size_ratio, stiffness_ratio, largest_overlap, dt_safe, dt_limit_upper, method, estimates:
/// {name: {dt, ratio, unstable}}}], times in s.
nlohmann::json json_of(const std::vector<StudyRow>& rows);
/// Rules over stress, for the lattices and the random packings.
Figure figure_of(const std::vector<StudyRow>& rows);

}  // namespace eg
