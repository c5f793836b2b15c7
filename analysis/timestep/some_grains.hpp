#pragma once
// A few grains of a state and what touches them, as a network of their own.
#include <vector>

#include "assembly/network.hpp"
#include "state/state.hpp"

namespace eg {

/// Grains numbered anew in the order in which they are taken in.
class SomeGrains {
 public:
  SomeGrains(const State& state);
  /// Its number.
  Index take_in(Index grain);
  bool has(Index grain) const { return local_[grain] != no_index; }
  Index number_of(Index grain) const { return local_[grain]; }
  const std::vector<Index>& grains() const { return grains_; }

  /// Listed pairs that touch one of them, as places in State::contacts; the same of State::wall_contacts.
  std::vector<std::size_t> pairs() const;
  std::vector<std::size_t> walls() const;
  /// The grains, no springs yet.
  Network network() const;

 private:
  const State& state_;
  std::vector<Index> local_;  ///< of every grain of the state
  std::vector<Index> grains_;
};

}  // namespace eg
