#pragma once
#include "assembly/network.hpp"

namespace eg {

struct BackboneNetwork {
  Network network;           ///< the same grains; those that carry nothing have no springs
  std::size_t rattlers = 0;  ///< grains that carry nothing
};

/// Leaves out the springs of grains held by one contact or none, again and again (with friction two contacts are needed
/// for equilibrium; any number may carry load without), and makes grains that cannot move walls of their neighbours.
/// Relaxed, such springs carry nothing: the moduli do not change, their affine part does.
BackboneNetwork backbone(const Network& network);

}  // namespace eg
