#pragma once
#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <string>

namespace eg {

/// The number that a word of the command line is as a whole; NaN: it is none, or not finite.
inline double number_of(const std::string& text) {
  double value = 0;
  const auto begin = text.data() + text.starts_with('+'), end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(begin, end, value);
  return error == std::errc() && rest == end && std::isfinite(value) ? value : NAN;
}

/// Check of a command line number that must be finite and above 0; CLI11's own quotes the largest double in full.
inline std::string above_zero(const std::string& text) {
  return number_of(text) > 0 ? std::string() : "value " + text + " must be a number above 0";
}

inline std::string finite(const std::string& text) {
  return std::isnan(number_of(text)) ? "value " + text + " must be a finite number, without a unit" : std::string();
}

inline const CLI::Validator positive_option(above_zero, "POSITIVE"), finite_option(finite, "");

}  // namespace eg
