#pragma once
// ParaView output.
#include <span>
#include <string>
#include <vector>

#include "measure/force_chains.hpp"
#include "measure/zone_grid.hpp"
#include "state/state.hpp"

namespace eg {

/// Numbers of every grain, `components` each, in the order of State::grains.
struct GrainField {
  std::string name;
  int components = 1;
  std::vector<double> data;
};

/// Writes the grains as points of a .vtp file (VTK XML PolyData, raw appended data) with arrays radius [m],
/// velocity [m/s] (the true one, v = c + L·x), id and those of `fields`. Throws RunError when the file cannot be
/// written.
void write_vtp(const std::string& path, const State&, std::span<const GrainField> fields = {});

/// Writes the contacts as lines between the centres of two grains (across a periodic face: to the image; at a wall: to
/// its plane) of a .vtp file, with arrays normal_force, shear_force [N], force (on the second grain) [N], strong (above
/// the mean), sliding (0 or 1) and chain (number of the force chain, −1: none). Throws RunError when the file cannot be
/// written.
void write_network_vtp(const std::string& path, const State&, std::span<const ContactPoint>, const ForceChains&);

/// Writes zones that are the equal cells of a box as a .vti file (VTK XML ImageData) with a void_ratio (NaN in an empty
/// cell), a solid_fraction and the number of particles a cell. Throws RunError when the file cannot be written.
void write_vti(const std::string& path, const ZoneGrid&, const ZoneTable&);

}  // namespace eg
