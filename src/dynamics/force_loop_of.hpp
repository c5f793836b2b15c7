#pragma once
#include "dynamics/force_loop.hpp"

namespace eg {

/// The loop of one law; defined and instantiated in one source file a law (force_loop_<law>.cpp), to keep compile times
/// low.
template <class Law>
std::unique_ptr<ForceLoop> make_force_loop_of(bool frictionless, bool rotation);

}  // namespace eg
