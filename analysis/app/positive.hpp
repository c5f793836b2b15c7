#pragma once
#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <string>

namespace eg {

/// Check of a command line number that must be finite and above 0; CLI11's own quotes the largest double in full.
inline std::string above_zero(const std::string& text) {
  double value = 0;
  const auto end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  if (error == std::errc() && rest == end && std::isfinite(value) && value > 0) return {};
  return "value " + text + " must be a number above 0";
}

inline const CLI::Validator positive_option(above_zero, "POSITIVE");

}  // namespace eg
