#pragma once
// What `eigengrain measure --since` adds: displacements, strains, shear band, gauges. Definitions: docs/measures.md.
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "app/measure_report.hpp"
#include "io/vtk.hpp"
#include "measure/displacement.hpp"

namespace eg {

struct SinceFlags {
  std::string snapshot;                     ///< the earlier one; empty: nothing is compared
  std::vector<std::vector<double>> gauges;  ///< places in the earlier snapshot [m]
  std::string fields;                       ///< .vtp to write
};

/// Adds --since, --gauge and --fields; `flags` must outlive the parsing.
void add_since_options(CLI::App& command, SinceFlags& flags);

/// The later state against an earlier one.
struct Since {
  Displacements motion;
  double elapsed = 0;           ///< [s]
  double window = 0;            ///< reach of local gradients: 2.5 d50 [m]
  std::vector<Mat3> gradients;  ///< around every grain of `motion`
};

/// Reads the earlier snapshot and compares. Throws InputError when that is none, or none of this packing.
Since compare(const SinceFlags& flags, const State& now);

/// Adds sections "since", "shear_band" and "gauge_1" … to the report, and displacement and strain to the sections of
/// its spheres. Throws InputError for a gauge that is no place.
void add_since(MeasureReport& report, const Since& since, const SinceFlags& flags, const State& now,
               std::span<const MeasureSphere> spheres);

/// Displacement, fluctuation about the best homogeneous motion, strain, rotation of the material, for every grain of
/// the later state (NaN for one that the earlier state lacks).
std::vector<GrainField> since_fields(const Since& since, std::size_t grains);

}  // namespace eg
