#pragma once
// Snapshots: the whole State and the text of its scene in one HDF5 file. A run goes on from it bit for bit.
#include <string>

#include "state/scene.hpp"
#include "state/state.hpp"

namespace eg {

struct Snapshot {
  Scene scene;
  State state;
};

/// Writes path at once and whole: a reader sees the old file or the new one. Scene::text must hold the scene, since
/// that is what a reader gets its Scene from. Throws RunError when the file cannot be written.
void write_snapshot(const std::string& path, const Scene&, const State&);

/// Reads a snapshot and checks that it belongs together (grain numbers in range, finite positions, …). Throws
/// InputError, one line, for a file that is missing, foreign, damaged or of another format version.
Snapshot read_snapshot(const std::string& path);

/// True when the file begins as HDF5 files do; false too for a file that cannot be opened.
bool looks_like_snapshot(const std::string& path);

}  // namespace eg
