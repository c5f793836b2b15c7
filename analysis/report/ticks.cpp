#include "report/ticks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace eg {

std::string power_of_ten(int exponent) {
  static constexpr std::array digits{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = exponent < 0 ? "10⁻" : "10";
  for (const char c : std::to_string(std::abs(exponent))) text += digits[static_cast<std::size_t>(c - '0')];
  return text;
}

namespace {

int decade(double value) { return static_cast<int>(std::floor(std::log10(value))); }

/// The least of 1, 2, 5, 10 times a power of ten that is not below `value`.
double round_step(double value) {
  const double ten = std::pow(10.0, decade(value));
  for (const double m : {1.0, 2.0, 5.0})
    if (m * ten >= value * (1 - 1e-9)) return m * ten;
  return 10 * ten;
}

std::string log_label(int multiple, int exponent, bool plain) {
  if (plain) return fmt::format("{:.12g}", multiple * std::pow(10.0, exponent));
  return (multiple == 1 ? "" : fmt::format("{}×", multiple)) + power_of_ten(exponent);
}

}  // namespace

Ticks linear_ticks(double low, double high, int wanted) {
  Ticks result;
  const double step = round_step((high - low) / wanted);
  const double largest = std::max(std::abs(low), std::abs(high));
  if (largest >= 1e5 || largest < 1e-2) result.exponent = 3 * static_cast<int>(std::floor(decade(largest) / 3.0));
  const double unit = std::pow(10.0, result.exponent);
  const int decimals = std::max(0, result.exponent - decade(step * (1 + 1e-9)));
  const auto first = static_cast<long>(std::ceil(low / step - 1e-9));
  const auto last = static_cast<long>(std::floor(high / step + 1e-9));
  for (long k = first; k <= last; ++k) {
    const double value = std::clamp(static_cast<double>(k) * step, low, high);
    result.ticks.push_back({value, fmt::format("{:.{}f}", static_cast<double>(k) * step / unit, decimals)});
  }
  return result;
}

Ticks log_ticks(double low, double high) {
  const double decades = std::log10(high / low);
  if (decades < 0.6) return linear_ticks(low, high);
  const int first = decade(low), last = decade(high * (1 + 1e-12));
  const int stride = std::max(1, static_cast<int>(decades / 9) + (decades > 9));
  const bool plain = first >= -3 && last <= 4;
  Ticks result;
  for (int exponent = first; exponent <= last; ++exponent)
    for (int multiple = 1; multiple <= (stride == 1 ? 9 : 1); ++multiple) {
      const double value = multiple * std::pow(10.0, exponent);
      if (value < low * (1 - 1e-12) || value > high * (1 + 1e-12)) continue;
      const bool labelled = multiple == 1 ? exponent % stride == 0 : decades < 2.5 && (multiple == 2 || multiple == 5);
      result.ticks.push_back({value, labelled ? log_label(multiple, exponent, plain) : ""});
    }
  return result;
}

}  // namespace eg
