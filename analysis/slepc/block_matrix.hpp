#pragma once
// Block matrices of a packing that is shared among processes: a block a grain, rows where the grain is.
#include <functional>
#include <vector>

#include "assembly/network.hpp"
#include "io/snapshot_part.hpp"
#include "slepc/session.hpp"

namespace eg {

/// Receives the d×d block (row major) that couples two grains of a part, numbers as in the part.
using AddBlock = std::function<void(Index row, Index column, const double* block)>;

/// M^−½ A M^−½ [1/s²], A the sum of the blocks that `emit` hands out. `emit` is called once; blocks whose rows belong
/// to other processes are sent there. `shape`: masses and pairs of the part, as linearise() gives them.
MatHandle make_block_matrix(const SnapshotPart& part, const Network& shape,
                            const std::function<void(const AddBlock&)>& emit);

/// K of the network, every contact sticking; also C when the springs are dashpots.
MatHandle make_stiffness(const SnapshotPart& part, const Network& network);

/// The exact tangent of the forces: sliding contacts included, nonsymmetric.
MatHandle make_tangent(const SnapshotPart& part, const Network& shape);

/// An upper bound of the spectral radius of a block matrix [1/s²] by block Collatz–Wielandt: max_i (Ny)_i/y_i with
/// N_ij = ‖A_ij‖₂ and any y > 0 (Varga 2000, section 2.1), `sweeps` power steps choosing y. Round-off included.
double collatz_radius(::Mat matrix, int sweeps = 40);

}  // namespace eg
