#pragma once
// ParaView output.
#include <string>

#include "state/state.hpp"

namespace eg {

/// Writes the grains as points of a .vtp file (VTK XML PolyData, raw appended data) with arrays radius [m],
/// velocity [m/s] (the true one, v = c + L·x) and id. Throws RunError when the file cannot be written.
void write_vtp(const std::string& path, const State&);

}  // namespace eg
