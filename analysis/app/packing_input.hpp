#pragma once
// What every question about one packing takes from the command line: the packing, its material if it is bare, threads.
#include <CLI/CLI.hpp>
#include <string>

#include "app/prepare.hpp"
#include "report/plot.hpp"

namespace eg {

struct PackingFlags {
  std::string input;
  SceneSettings settings;
  BareFlags bare;
  std::string bare_flag;  ///< one of those given that only a bare packing can take, or ""
  bool initial = false, json = false;
  int threads = 0;
};

/// Adds INPUT, --set, --initial, --json, --threads, --no-rotation and the material of bare packings; `flags` must
/// outlive the parsing.
void add_packing_options(CLI::App& command, PackingFlags& flags);

/// The packing with up-to-date lists: a scene's stages are run first unless `initial`. Sets the number of threads.
/// Throws InputError.
Snapshot load_packing(const PackingFlags& flags);

/// Throws InputError when `path` is given and its ending names no format of figures: long work must not end in a figure
/// that cannot be written.
void check_figure(const std::string& path);

/// Writes the figure and says so on stderr; makes its folder.
void save_figure(const Figure& figure, const std::string& path);

}  // namespace eg
