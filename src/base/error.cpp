#include "base/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace eg {

InputError input_error(std::string_view file, long line, std::string_view subject, std::string_view rule,
                       std::string_view remedy) {
  std::string text(file);
  if (line > 0) text += fmt::format(":{}", line);
  text += fmt::format(": {} {}", subject, rule);
  if (!remedy.empty()) text += fmt::format("; {}", remedy);
  return InputError(text);
}

std::string nearest(std::string_view word, const std::vector<std::string>& candidates) {
  const auto distance = [&](std::string_view other) {  // Levenshtein
    std::vector<std::size_t> row(other.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < word.size(); ++i) {
      std::size_t diagonal = row[0]++;
      for (std::size_t j = 0; j < other.size(); ++j) {
        const std::size_t change = diagonal + (word[i] != other[j]);
        diagonal = row[j + 1];
        row[j + 1] = std::min({row[j] + 1, row[j + 1] + 1, change});
      }
    }
    return row.back();
  };
  std::string best;
  std::size_t best_distance = std::min(std::max<std::size_t>(2, word.size() / 3) + 1, word.size());
  for (const auto& candidate : candidates)
    if (const auto d = distance(candidate); d < best_distance) best = candidate, best_distance = d;
  if (best.empty() && word.size() > 2)
    for (const auto& candidate : candidates)
      if (candidate.starts_with(word)) return candidate;  // cut short
  return best;
}

}  // namespace eg
