// eigengrain: discrete elements with a proved time step.
#include <fmt/format.h>

#include <cstdio>
#include <exception>

#include "app/commands.hpp"
#include "base/error.hpp"
#include "base/version.hpp"

int main(int argc, char** argv) {
  CLI::App app{"eigengrain: discrete elements with a proved time step (SI units everywhere)", "eigengrain"};
  app.require_subcommand(1);
  app.set_version_flag("--version", eg::version());
  app.failure_message([](const CLI::App* a, const CLI::Error& e) {
    return fmt::format("eigengrain: {}; `eigengrain {}--help` lists what there is\n", e.what(),
                       a->get_subcommands().empty() ? "" : a->get_subcommands().front()->get_name() + " ");
  });
  eg::Action action;
  eg::add_run_command(app, action);
  eg::add_timestep_command(app, action);
  eg::add_info_command(app, action);
  CLI11_PARSE(app, argc, argv);
  try {
    return action();
  } catch (const eg::InputError& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 2;
  } catch (const eg::RunError& e) {
    fmt::print(stderr, "eigengrain: {}\n", e.what());
    return 3;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "eigengrain: out of memory; use fewer grains\n");
    return 4;
  } catch (const std::exception& e) {
    fmt::print(stderr, "eigengrain: {}\n", e.what());
    return 1;
  }
}
