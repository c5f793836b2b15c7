#pragma once
// One row of a run's history, and the checks a run makes of itself.
#include <string>
#include <vector>

#include "dynamics/run.hpp"
#include "io/history.hpp"
#include "measure/homogenised.hpp"
#include "timestep/controller.hpp"

namespace eg {

/// Columns of the history of this scene (energies only when its ledger is kept).
std::vector<HistoryColumn> history_columns(const Scene& scene);

/// The values of a row, in the order of history_columns(); `h` is homogenise() of the state, here and below.
std::vector<double> history_row(const Scene& scene, const State& state, const RunStatus& status, const Homogenised& h);

/// Assumptions of the method that the state breaks, one line each: overlap above 5 % of the smaller diameter, inertial
/// number above 2.5e-3 in a stage that drives strain, energy drift above 1 % of the work done, step above the certified
/// limit.
std::vector<std::string> broken_assumptions(const Scene& scene, const State& state, const RunStatus& status,
                                            const Homogenised& h);

/// Energies of a state [J]: elastic part from the contacts, the rest from its ledger.
struct EnergyTable {
  double kinetic = 0, normal = 0, shear = 0;  ///< stored
  double friction = 0, path = 0;              ///< by sliding; by the path dependence of the tangential law
  double damping = 0;                         ///< local, mass and contact damping together
  double work = 0;                            ///< done from outside: boundary and body
  double residual = 0;                        ///< what does not balance
};
EnergyTable energies(const Scene& scene, const State& state, double kinetic);

}  // namespace eg
