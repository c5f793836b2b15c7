#pragma once
// Errors that a user can mend. Every message is one line: where, what, the rule it breaks, the remedy.
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace eg {

/// Wrong input: a scene key, a value, a file, a flag. `what()` is the whole line for the user.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A run that cannot go on (lost grain, unstable step, impossible target). `what()` is the whole line for the user.
struct RunError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// "file:line: subject rule; remedy": line 0 leaves the line out, an empty remedy leaves the remedy out.
InputError input_error(std::string_view file, long line, std::string_view subject, std::string_view rule,
                       std::string_view remedy = {});

/// The candidate nearest to `word` by edit distance, or "" when none is near (for "did you mean …?").
std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace eg
