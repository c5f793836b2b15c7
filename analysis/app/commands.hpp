#pragma once
// The command line: one file a subcommand. Each adds itself to the CLI and sets `run` to what it does.
#include <CLI/CLI.hpp>
#include <functional>

namespace eg {

using Action = std::function<int()>;  ///< exit status

void add_run_command(CLI::App& app, Action& action);
void add_timestep_command(CLI::App& app, Action& action);
void add_stiffness_command(CLI::App& app, Action& action);
void add_waves_command(CLI::App& app, Action& action);
void add_study_command(CLI::App& app, Action& action);
void add_measure_command(CLI::App& app, Action& action);
void add_plot_command(CLI::App& app, Action& action);
void add_info_command(CLI::App& app, Action& action);

}  // namespace eg
