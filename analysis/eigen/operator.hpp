#pragma once
// A matrix is whatever can be applied. Solvers ask for nothing more.
#include <concepts>
#include <cstddef>
#include <span>

namespace eg {

template <class A>
concept LinearOperator = requires(const A& a, std::span<const double> x, std::span<double> y) {
  { a.rows() } -> std::convertible_to<std::size_t>;
  {a.apply(x, y)};  // y = A x
};

}  // namespace eg
