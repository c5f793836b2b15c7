#pragma once
#include <string>

#include "assembly/network.hpp"

namespace eg {

/// A network for other programs (matlab_compat/README.md): a line `dimension grains springs`; a line `1/m 1/I` a grain
/// [1/kg, 1/(kg m²)]; a line `i j bx by bz kn kt ai aj` a spring, grains from 1 (j = 0: a wall), branch vector [m],
/// stiffnesses [N/m], arms [m]. Throws InputError when the file cannot be written.
void write_springs(const Network& network, const std::string& path);

}  // namespace eg
