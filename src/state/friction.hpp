#pragma once
// Which friction coefficient is in force between which materials.
#include <optional>
#include <vector>

#include "state/scene.hpp"
#include "state/state.hpp"

namespace eg {

/// µ of every pair of materials, row after row: that of the stage if it gives one for all; where it gives one for
/// either material, the smaller one of both as they are then; else of the last [[contact.pair]] for these two, else the
/// smaller one of both materials.
std::vector<double> pair_friction(const Scene&, const StageSpec& stage = {});

/// State::friction, or that of the scene where the state has none yet.
std::vector<double> friction_in_force(const Scene&, const State&);

/// Whether any contact of any stage can have friction.
bool has_friction(const Scene&);

/// As [contact.friction_scatter] of the scene says.
FrictionScatter friction_scatter(const Scene&);

/// Puts the scatter in force: for contacts to come, and for those at hand.
void scatter_friction(State&, const FrictionScatter&);

/// Factor on µ of a contact between grains of these ids: 1 + deviation · z with z from a standard normal distribution,
/// never below 0; by grain the smaller one of both grains'. A pure function of seed and ids, so that it does not depend
/// on the order of contacts, and a contact that comes back has the friction that it had.
double friction_factor(const FrictionScatter&, Index id_i, Index id_j);
double wall_friction_factor(const FrictionScatter&, Index id, Index wall);

}  // namespace eg
