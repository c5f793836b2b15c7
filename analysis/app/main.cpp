// eigengrain: discrete elements with a proved time step.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>

#include "app/commands.hpp"
#include "base/environment.hpp"
#include "base/error.hpp"
#include "base/version.hpp"

namespace {

/// A word in the place of a subcommand that names none is a misspelt one; the parser would only say that there is none.
void check_subcommand(const CLI::App& app, char** words, const std::string& before) {
  const auto subcommands = app.get_subcommands([](const CLI::App* a) { return !a->get_name().empty(); });
  if (subcommands.empty() || !*words || **words == '-') return;
  std::vector<std::string> names;
  for (const auto* sub : subcommands) names.push_back(sub->get_name());
  const auto found = std::ranges::find(names, *words);
  if (found != names.end())
    return check_subcommand(*subcommands[static_cast<std::size_t>(found - names.begin())], words + 1,
                            before + " " + *words);
  const auto meant = eg::nearest(*words, names);
  throw eg::InputError(fmt::format("{}: {} is not a subcommand; {}", before, *words,
                                   meant.empty() ? fmt::format("`{} --help` lists what there is", before)
                                                 : fmt::format("did you mean \"{}\"?", meant)));
}

/// The subcommand in use, and the words that lead to it.
std::pair<const CLI::App*, std::string> used_command(const CLI::App& app) {
  const CLI::App* used = &app;
  std::string words = app.get_name();
  while (!used->get_subcommands().empty()) {
    used = used->get_subcommands().front();
    words += " " + used->get_name();
  }
  return {used, words};
}

/// The options of the subcommand in use that words of the command line may have meant.
std::string meant_options(const CLI::App& app) {
  const CLI::App* used = used_command(app).first;
  std::vector<std::string> names;
  for (const auto* option : used->get_options())
    for (const auto& name : option->get_lnames()) names.push_back("--" + name);
  std::string text;
  for (const auto& word : app.remaining(true)) {
    const auto meant = word.starts_with("--") ? eg::nearest(word.substr(0, word.find('=')), names) : "";
    if (!meant.empty()) text += fmt::format("; did you mean \"{}\"?", meant);
  }
  return text;
}

}  // namespace

int main(int argc, char** argv) {
  eg::fit_environment(argv);
  CLI::App app{"eigengrain: discrete elements with a proved time step (SI units everywhere)", "eigengrain"};
  app.require_subcommand(1);
  app.set_version_flag("--version", eg::version());
  app.failure_message([](const CLI::App* a, const CLI::Error& e) {
    return fmt::format("eigengrain: {}{}; `{} --help` lists what there is\n", e.what(),
                       e.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError) ? meant_options(*a) : "",
                       used_command(*a).second);
  });
  eg::Action action;
  eg::add_run_command(app, action);
  eg::add_timestep_command(app, action);
  eg::add_stiffness_command(app, action);
  eg::add_waves_command(app, action);
  eg::add_study_command(app, action);
  eg::add_measure_command(app, action);
  eg::add_plot_command(app, action);
  eg::add_info_command(app, action);
  try {
    check_subcommand(app, argv + 1, app.get_name());
    app.parse(argc, argv);
    const int status = action();
    if (std::fflush(stdout) != 0 || std::ferror(stdout)) throw eg::RunError("the output could not be written");
    return status;
  } catch (const CLI::Success& e) {
    return app.exit(e);
  } catch (const CLI::Error& e) {
    app.exit(e);
    return 2;
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
