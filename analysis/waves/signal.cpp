#include "waves/signal.hpp"

#include <cmath>
#include <numbers>

namespace eg {
namespace {
constexpr double pi = std::numbers::pi;
}

double Signal::duration() const {
  switch (kind) {
    case Kind::sine:
      return 1 / frequency;
    case Kind::ricker:
      return 3 / frequency;  // the rest is below 1e-8
    case Kind::sweep:
      return 20 / (frequency + last);
  }
  return 0;
}

double Signal::operator()(double t) const {
  const double length = duration();
  if (!(t > 0 && t < length)) return 0;
  switch (kind) {
    case Kind::sine:
      return std::sin(2 * pi * frequency * t);
    case Kind::ricker: {
      const double q = std::pow(pi * frequency * (t - length / 2), 2);
      return (1 - 2 * q) * std::exp(-q);
    }
    case Kind::sweep:
      return std::pow(std::sin(pi * t / length), 2) *
             std::sin(2 * pi * (frequency * t + (last - frequency) * t * t / (2 * length)));
  }
  return 0;
}

}  // namespace eg
