#pragma once
// K·x and M^−½ K M^−½·x straight from the springs, without a matrix: about 70 bytes a contact.
//
// Result: bitwise the same for any number of threads. Grains are cut into fixed chunks; a chunk owns the springs whose
// first grain it holds and sums what they exert on grains of other chunks into private (halo) rows, which the last pass
// adds in a fixed order.
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "assembly/network.hpp"

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

  struct alignas(64) Row {
    double u[3] = {}, turn[3] = {}, pad[2] = {};
  };
  struct Link {  ///< what one spring needs
    Vec3 n;
    double normal, tangential, arm_i, arm_j;
    Index i, j;        ///< rows to read; a wall reads the row of zeros behind the grains
    Index to_i, to_j;  ///< rows of sums to add to
  };
  struct Chunk {
    std::size_t first_link, first_sum;
  };

  void build_chunks(const Network& network);
  void load(std::size_t grain, const double* x) const;
  void sum_chunk(std::size_t chunk) const;
  void store(std::size_t grain, double* y) const;

  std::size_t grains_, width_;
  std::vector<int> components_;             ///< entry of a row (0…5) behind each degree of freedom of a grain
  std::vector<double> scale_, turn_scale_;  ///< m^−½, I^−½ a grain
  std::vector<Link> links_;
  std::vector<Chunk> chunks_;                         ///< one more than there are, as an end mark
  std::vector<std::uint32_t> halo_begin_, halo_sum_;  ///< sums of other chunks for a grain, in chunk order
  mutable std::vector<Row> rows_, sums_;
};

}  // namespace eg
