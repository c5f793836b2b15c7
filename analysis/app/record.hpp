#pragma once
// One row of a run's history, and the checks a run makes of itself.
#include <string>
#include <vector>

#include "io/history.hpp"
#include "measure/homogenised.hpp"
#include "timestep/controller.hpp"

namespace eg {

/// Columns of the history of this scene (energies only when its ledger is kept).
std::vector<HistoryColumn> history_columns(const Scene& scene);

/// Columns of timestep.csv, a row for every evaluation of the step; `share`: of the wall clock so far that choosing and
/// checking the step took [-].
std::vector<HistoryColumn> step_columns();
std::vector<double> step_row(const State& state, double share);

/// The stage that a state is in; after the last stage that one, and one that drives nothing when there is none.
const StageSpec& current_stage(const Scene& scene, const State& state);

/// I of the packing by driving_rate(), d50 and the density of the first material; 0 when nothing moves or presses.
double inertial_number_of(const Scene& scene, const State& state, const Homogenised& h);

/// The values of a row, in the order of history_columns(); `h` is homogenise() of the state, here and below.
std::vector<double> history_row(const Scene& scene, const State& state, const Homogenised& h);

/// Assumptions of the method that the state breaks, one line each: overlap above 5 % of the smaller diameter, inertial
/// number above 2.5e-3 in a stage that drives strain, energy drift above 1 % of the work done, step above the certified
/// limit.
std::vector<std::string> broken_assumptions(const Scene& scene, const State& state, const Homogenised& h);

/// Energies of a state [J]: elastic part from the contacts, the rest from its ledger.
struct EnergyTable {
  double kinetic = 0, normal = 0, shear = 0;  ///< stored
  double friction = 0, path = 0;              ///< by sliding; by the path dependence of the tangential law
  double damping = 0;                         ///< local, mass and contact damping together
  double work = 0;                            ///< done from outside: boundary and body
  double residual = 0;                        ///< what does not balance
};
EnergyTable energies(const Scene& scene, const State& state);

}  // namespace eg
