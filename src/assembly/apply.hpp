#pragma once
// K·x and M^−½ K M^−½·x straight from the springs, without a matrix: 64 bytes a contact, eight contacts at a time.
//
// Grains are cut into fixed chunks; a chunk owns the springs whose first grain it holds, and works in rows of its own
// that stay in the second-level cache: its grains, and those of later chunks that its springs reach ("halo"). Chunks
// are taken last to first, so that the halo finds its place in y set already.
//
// Result: bitwise the same for any number of threads. What a thread's chunks exert on grains of another thread's waits
// until all are done, and is added in the same order then.
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "assembly/network.hpp"
#include "base/aligned.hpp"
#include "base/batch.hpp"

namespace eg {

class StiffnessOperator {
 public:
  enum class Scaling {
    none,  ///< K [N/m, N, N m]
    mass,  ///< M^−½ K M^−½ [1/s²]; grains that cannot move have zero rows
  };

  StiffnessOperator(const Network& network, Scaling scaling);

  /// total_dofs(network); order as in assembly/stiffness.hpp.
  std::size_t rows() const { return grains_ * width_; }

  /// y = A x. Uses scratch of the object: one call at a time.
  void apply(std::span<const double> x, std::span<double> y) const;

 private:
  static constexpr std::size_t chunk_grains = 1024;
  static constexpr std::size_t lanes = 8;

  struct alignas(64) Links {  ///< what eight springs need; unused lanes are zero springs of a grain with itself
    double nx[lanes] = {}, ny[lanes] = {}, nz[lanes] = {};
    double tangential[lanes] = {}, excess[lanes] = {};  ///< kt, kn − kt
    double arm_i[lanes] = {}, arm_j[lanes] = {};
    Index i[lanes] = {}, j[lanes] = {};  ///< rows of the chunk: its grains, the row of zeros of walls, its halo
  };

  struct Couple {  ///< a spring of couples as one of its grains sees it; a wall is no_index
    Vec3 n;
    double rolling = 0, excess = 0;  ///< stiffness across n, and what twisting about n has more
    Index other = 0;
  };

  struct Chunk {
    std::size_t first_link = 0, first_halo = 0;
  };

  struct Late {  ///< what a chunk of one thread exerts on a grain of another's: force | moment
    Double8 row;
    Index grain;
  };

  struct Scratch {  ///< of a thread; rows u | θ, then force | moment, a cache line each
    AlignedVector<Double8> motion, force;
    AlignedVector<Late> late;
  };

  /// Entries of x and y as rows u | θ; `component`: those that are degrees of freedom.
  template <int... component>
  struct Entries;

  void build_links(const Network& network);
  void build_couples(const Network& network);
  template <class Rows>
  Vec3 couple_on(std::size_t grain, const double* x) const;
  template <class Rows>
  void run(const double* x, double* y) const;
  template <class Rows>
  void run_chunk(std::size_t chunk, std::size_t end, const double* x, double* y, Scratch& scratch) const;
  void sum(std::size_t chunk, const Double8* motion, Double8* force) const;
  Double8 scale(std::size_t grain) const { return halves(scale_[grain][0], scale_[grain][1]); }

  std::size_t grains_, width_, most_rows_ = 0;
  bool solid_, rotation_;
  std::vector<std::array<double, 2>> scale_;  ///< m^−½, I^−½ a grain
  AlignedVector<Links> links_;
  std::vector<std::size_t> couple_begin_;  ///< couples of grain g: [couple_begin_[g], couple_begin_[g + 1])
  std::vector<Couple> couples_;
  std::vector<Chunk> chunks_;  ///< and an end mark
  std::vector<Index> halo_;    ///< grains
  mutable std::vector<Scratch> scratch_;
};

}  // namespace eg
