#pragma once
// The time step of a snapshot that is shared among processes.
#include <optional>
#include <string>

#include "eigen/general_spectrum.hpp"
#include "slepc/session.hpp"

namespace eg {

struct SharedTimestep {
  std::size_t particles = 0, contacts = 0, rows = 0;
  double lambda_lower = 0, lambda_upper = 0;  ///< of M⁻¹K, contacts sticking [1/s²]
  double residual = 0;                        ///< relative
  int products = 0;                           ///< with the matrix, at most
  std::optional<double> dt_damped;            ///< limit with the dashpots and mass damping in force, an upper end [s]
  std::optional<GeneralSpectrum> consistent;  ///< of the ends of the consistent spectrum
  double radius_upper = 0;                    ///< bound of its radius [1/s²]
  double asymmetry = 0;                       ///< ‖A − Aᵀ‖/‖A‖ of it (Frobenius) [-]
};

/// Each process reads its part of the snapshot and assembles its rows. `consistent`: the exact tangent too.
SharedTimestep shared_timestep(const SlepcSession& session, const std::string& path, bool consistent);

}  // namespace eg
