#include "base/environment.hpp"

#include <unistd.h>

#include <cstdlib>

namespace eg {

void fit_environment(char** argv) {
  if (std::getenv("EIGENGRAIN_STARTED")) return;
  ::setenv("EIGENGRAIN_STARTED", "1", 1);
  // OpenMP's own default of some 10 ms slows a run down tenfold on a machine with other work on it. Threads that sleep
  // in every gap cost half of a step at 10,000 grains: this is some 300 µs, the gap two to three times as short.
  if (!std::getenv("OMP_WAIT_POLICY")) {
    ::setenv("GOMP_SPINCOUNT", "10000", 0);
    ::setenv("KMP_BLOCKTIME", "1", 0);  // clang's: whole milliseconds
  }
  // Small pages: their search takes a twentieth of a step at 100,000 grains. Memory that goes back to the system at
  // every rebuild of the lists comes again page by page, cleared: a thirtieth of the time in fast flow.
  ::setenv("GLIBC_TUNABLES",
           "glibc.malloc.hugetlb=1:glibc.malloc.mmap_threshold=33554432:glibc.malloc.trim_threshold=268435456", 0);
  ::execv("/proc/self/exe", argv);  // returns only when it fails; nothing is lost then
}

}  // namespace eg
