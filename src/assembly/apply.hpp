#pragma once
// K·x and M^−½ K M^−½·x straight from the springs, without a matrix: about 70 bytes a contact, eight contacts at a
// time.
//
// Result: bitwise the same for any number of threads. Grains are cut into fixed chunks; a chunk owns the springs whose
// first grain it holds and sums what they exert on grains of other chunks into private (halo) rows, which the last pass
// adds in a fixed order.
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "assembly/network.hpp"
#include "base/aligned.hpp"
#include "state/schedule.hpp"

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
  };

  struct Couple {  ///< a spring of couples as one of its grains sees it; a wall is the row of zeros
    Vec3 n;
    double rolling = 0, excess = 0;  ///< stiffness across n, and what twisting about n has more
    Index other = 0;
  };

  void build_links(const Network& network);
  void build_couples(const Network& network);
  Vec3 couple_on(std::size_t grain) const;
  template <int... component>
  void run(const double* x, double* y) const;
  template <int... component>
  void load(std::size_t chunk, const double* x) const;
  void sum(std::size_t chunk) const;
  template <int... component>
  void store(std::size_t chunk, double* y) const;

  std::size_t grains_, width_;
  bool solid_, rotation_;
  std::vector<double> scale_, turn_scale_;  ///< m^−½, I^−½ a grain
  std::vector<Links> links_;
  std::vector<Index> i_, j_;               ///< grains of each lane; a wall is the row of zeros behind the grains
  std::vector<std::size_t> couple_begin_;  ///< couples of grain g: [couple_begin_[g], couple_begin_[g + 1])
  std::vector<Couple> couples_;
  std::vector<std::size_t> first_links_;  ///< of each chunk, and an end mark
  Schedule schedule_;
  mutable AlignedVector<Quad> u_, turn_, sums_;
};

}  // namespace eg
