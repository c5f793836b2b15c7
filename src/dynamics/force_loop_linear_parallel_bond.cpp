#include "contact/linear_parallel_bond.hpp"
#include "dynamics/force_loop_impl.hpp"
#include "dynamics/force_loop_of.hpp"

template std::unique_ptr<eg::ForceLoop> eg::make_force_loop_of<eg::LinearParallelBond>(bool, bool);
