#pragma once
// Figures of a slice through a packing: forces, void ratios, strains, displacements.
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "app/since_report.hpp"

namespace eg {

struct SliceFlags {
  std::vector<std::string> slice;  ///< AXIS, POSITION and THICKNESS [m]
  std::string void_map;            ///< .vti to write
  double cell = 0;                 ///< edge of the cells of void ratios [m]; 0: 2 d50
};

/// Adds --slice, --void-map and --map-cell; `flags` must outlive the parsing.
void add_slice_options(CLI::App& command, SliceFlags& flags);

/// "force-slice", "void-slice"; "shear-slice" and "displacement-slice" need a comparison.
const std::vector<std::string>& slice_figures();

/// Draws one of slice_figures(). `since` may be null for those that need none. Throws InputError for a slice that is
/// none, for a figure that lacks its comparison, and when the file cannot be written.
void draw_slice(const std::string& kind, const SliceFlags& flags, const Snapshot& packing, const std::string& name,
                std::span<const ContactPoint> contacts, const Since* since, const std::string& path);

/// Writes the void ratios of the box around the specimen, cell by cell. Throws RunError when it cannot.
void write_void_map(const SliceFlags& flags, const State& state);

}  // namespace eg
