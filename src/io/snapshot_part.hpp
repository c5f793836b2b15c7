#pragma once
// Part of a snapshot, for programs that share a packing among several processes.
#include "io/snapshot.hpp"

namespace eg {

/// The grains [first, first + own) of a snapshot with the contacts whose first grain is one of them, in numbers of
/// their own: own grains in the order of the file, then those that they touch. What belongs to stepping (neighbour
/// list) is left out.
struct SnapshotPart {
  Scene scene;
  State state;
  std::size_t own = 0;        ///< grains that belong to this part; the others are only touched by them
  std::vector<Index> number;  ///< place of every grain in the file
  std::size_t grains = 0;     ///< in the whole file
};

/// Part `part` of `parts` (0 ≤ part < parts), cut where part_begin() says. Reads its own rows, the rows of grains that
/// they touch and little else. Throws InputError as read_snapshot() does.
SnapshotPart read_snapshot_part(const std::string& path, std::size_t part, std::size_t parts);

/// First grain of a part of equal parts.
inline std::size_t part_begin(std::size_t grains, std::size_t part, std::size_t parts) { return grains * part / parts; }

}  // namespace eg
