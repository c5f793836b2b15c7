// eigengrain waves: dispersion, modes and tests of wave propagation.
#include "app/waves_commands.hpp"

namespace eg {

void add_waves_command(CLI::App& app, Action& action) {
  auto* waves = app.add_subcommand("waves", "waves and modes of a packing");
  waves->require_subcommand(1);
  add_waves_dispersion(*waves, action);
  add_waves_modes(*waves, action);
  add_waves_transmit(*waves, action);
}

}  // namespace eg
