#include "contact/hertz_exponent.hpp"
#include "dynamics/force_loop_impl.hpp"
#include "dynamics/force_loop_of.hpp"

template std::unique_ptr<eg::ForceLoop> eg::make_force_loop_of<eg::HertzExponent>(bool, bool);
