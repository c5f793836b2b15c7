#pragma once
// How far grains have moved since the contacts were refreshed, and how much nearer two of them may have come by it.
// Grains that fall or flow together stay apart as they were: what counts is told from the bounding boxes of the
// displacements of blocks of grains, which are neighbours in memory and so in space.
#include <utility>
#include <vector>

#include "base/batch.hpp"
#include "state/state.hpp"

namespace eg {

/// Bounds, peculiar displacements only: what grains have beyond the motion of the cell.
struct Travel {
  double most = 0;      ///< of any grain [m]
  double approach = 0;  ///< of any two grains, none of which has moved further than the longest reach [m]
};

/// Displacements of blocks of grains. One that State::list does not know has gaps of at least three times
/// NeighbourList::longest to the grains of this one, and need not be looked at until some grain has moved that far.
class Blocks {
 public:
  /// No grain has moved; which blocks are near each other follows from list.reference.
  void reset(const State& state);
  /// Takes displacements from positions: tight boxes.
  void measure(const State& state);

  std::size_t count() const { return low_.size(); }
  std::size_t begin(std::size_t block) const { return block * size_; }
  std::size_t end(std::size_t block, std::size_t grains) const { return std::min(grains, (block + 1) * size_); }
  /// Grains of a block have moved on by no less than `low` and no more than `high` along each axis [m].
  void move(std::size_t block, Double4 low, Double4 high) { low_[block] += low, high_[block] += high; }
  /// The cell's rate of deformation [1/s] has turned displacements for dt [s]: to be told after the moves of a step.
  void deform(const Mat3& rate, double dt) { slack_ += (most() + slack_) * norm(rate) * dt; }

  Travel travel() const;  ///< from every two blocks that are near each other
  Travel coarse() const;  ///< from one box around all: no less, and cheap

 private:
  double most() const;

  std::size_t size_ = 0;             ///< grains a block
  std::vector<Double4> low_, high_;  ///< of the displacements of a block [m]; the fourth number is 0
  std::vector<std::size_t> begin_;   ///< blocks near block b, b and later ones: near_[begin_[b] … begin_[b + 1])
  std::vector<std::uint32_t> near_;
  double slack_ = 0;  ///< by which any displacement may be longer than its box says [m]
};

}  // namespace eg
