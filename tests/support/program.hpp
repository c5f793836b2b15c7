#pragma once
// main() of the programs that print tables: their command line, and what goes wrong as one line with an exit status.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "base/environment.hpp"

namespace eg::test {

/// Numbers of grains that a table of random packings takes: with fewer a periodic cell is narrower than its
/// neighbourhood.
inline const CLI::Range grain_counts(100, 100'000'000);

/// Reads the command line, then does `work`, whose value is the exit status; 2: wrong words, 3: the work cannot be
/// done.
template <class Work>
int run_program(CLI::App& app, int argc, char** argv, Work work) {
  fit_environment(argv);
  app.failure_message([](const CLI::App* a, const CLI::Error& e) {
    return fmt::format("{}: {}; `--help` lists what there is\n", a->get_name(), e.what());
  });
  try {
    app.parse(argc, argv);
    return work();
  } catch (const CLI::Success& e) {
    return app.exit(e);
  } catch (const CLI::Error& e) {
    app.exit(e);
    return 2;
  } catch (const std::exception& e) {
    std::fflush(stdout);
    fmt::print(stderr, "{}: {}\n", app.get_name(), e.what());
    return 3;
  }
}

}  // namespace eg::test
