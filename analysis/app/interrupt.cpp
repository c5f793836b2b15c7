#include "app/interrupt.hpp"

#include <csignal>

namespace eg {
namespace {
volatile std::sig_atomic_t asked = 0;  // a signal handler can reach nothing but a global
}

void catch_interrupts() {
  const auto handler = [](int signal) {
    asked = 1;
    std::signal(signal, SIG_DFL);
  };
  std::signal(SIGINT, handler);
  std::signal(SIGTERM, handler);
}

bool interrupted() { return asked != 0; }

}  // namespace eg
