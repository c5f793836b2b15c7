#pragma once
// Signals of wave tests: displacement of the source over its amplitude.
#include <string>

namespace eg {

struct Signal {
  enum class Kind {
    sine,    ///< one period of a sine
    ricker,  ///< second derivative of a Gaussian, spectrum with its top at `frequency`
    sweep,   ///< frequency rising evenly to `last`, ten periods of the mean frequency under a Hann window
  };
  Kind kind = Kind::sine;
  double frequency = 0;  ///< [Hz]
  double last = 0;       ///< sweep only [Hz]

  double operator()(double time) const;  ///< 0 before time 0 and after duration(); at most 1
  double duration() const;               ///< [s]
};

}  // namespace eg
