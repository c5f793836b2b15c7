#pragma once
// The one list of contact laws. A new law is its own header and one line here.
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "contact/hertz_exponent.hpp"
#include "contact/hertz_mindlin.hpp"
#include "contact/linear.hpp"
#include "contact/linear_parallel_bond.hpp"
#include "contact/linear_rolling.hpp"
#include "contact/partial_slip.hpp"
#include "contact/rough_hertz_mindlin.hpp"

namespace eg {

using Laws =
    std::tuple<Linear, LinearIncremental, HertzMindlin, HertzMindlinRescale, HertzExponent, HertzMindlinPartialSlip,
               RoughHertzMindlin, RoughPartialSlip, LinearRolling, LinearParallelBond>;

/// Names of all laws, in the order of the list.
inline std::vector<std::string> law_names() {
  return std::apply([](auto... law) { return std::vector<std::string>{std::string(decltype(law)::name)...}; }, Laws{});
}

/// Calls f(Law{}) for the law of that name; false when there is none.
template <class F>
bool with_law(std::string_view name, F&& f) {
  return std::apply([&](auto... law) { return ((decltype(law)::name == name && (f(law), true)) || ...); }, Laws{});
}

}  // namespace eg
