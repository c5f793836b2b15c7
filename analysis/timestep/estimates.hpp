#pragma once
// The rules of thumb for the time step that the literature offers, to stand beside the proved interval.
#include <optional>
#include <string>
#include <vector>

#include "assembly/network.hpp"

namespace eg {

/// What some rules need and a network does not hold. Rows whose numbers are missing are left out.
struct EstimateMaterial {
  std::optional<double> shear_modulus;  ///< G [Pa]
  std::optional<double> poisson;        ///< ν [-]
  std::optional<double> density;        ///< ρ [kg/m³]
  std::optional<double> max_speed;      ///< greatest relative speed expected at a contact [m/s], for Hertz's duration
};

struct Estimate {
  std::string name;  ///< stable key, e.g. "rayleigh-rmin"
  double dt = 0;     ///< [s]
  std::string formula;
  std::string source;
  bool rigorous = false;  ///< a proved lower bound of the critical step
};

/// Every rule that the network and the material allow; ascending in dt. Empty without springs or movable grains.
std::vector<Estimate> time_step_estimates(const Network& network, const EstimateMaterial& material = {});

/// Ranges that rules of thumb are made of. Masses and radii over movable grains; zero when there are none.
struct NetworkSummary {
  double mass_min = 0, mass_max = 0, mass_mean = 0;        ///< [kg]
  double radius_min = 0, radius_max = 0, radius_mean = 0;  ///< [m]
  double normal_min = 0, normal_max = 0, normal_mean = 0;  ///< kn [N/m]
  double tangential_min = 0, tangential_max = 0;           ///< kt [N/m]
  int coordination_max = 0;                                ///< most contacts on a movable grain, walls included
  double coordination_mean = 0;                            ///< the same, mean
  std::size_t movable = 0;
};
NetworkSummary summarise(const Network& network);

/// Contacts a grain, walls included; a contact with its own image counts twice.
std::vector<int> coordination_numbers(const Network& network);

/// The step below which no element (contact with its share of the grains' masses) alone is unstable, a lower bound of
/// the critical step (O'Sullivan and Bray 2004, after Irons and Treharne 1971) [s]; infinite without springs.
double element_time_step(const Network& network);

/// Gershgorin discs of M⁻¹K (rotations scaled by R) or of M^−½KM^−½, the better: a lower bound of the critical step
/// [s].
double gershgorin_time_step(const Network& network);

}  // namespace eg
