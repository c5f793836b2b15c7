#pragma once
#include <cstdlib>
#include <cstring>

#include "base/error.hpp"

/// Calls f. Only an InputError may come out of it, and only as one line that begins with the file.
template <class F>
void expect_result_or_one_line(F&& f) {
  try {
    f();
  } catch (const eg::InputError& error) {
    if (std::strncmp(error.what(), "fuzz:", 5) != 0 || std::strchr(error.what(), '\n')) std::abort();
  }
}
