#pragma once
// The subcommands of `eigengrain waves`, a file each.
#include "app/commands.hpp"

namespace eg {

void add_waves_dispersion(CLI::App& waves, Action& action);
void add_waves_modes(CLI::App& waves, Action& action);
void add_waves_transmit(CLI::App& waves, Action& action);

}  // namespace eg
