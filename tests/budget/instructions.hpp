#pragma once
// Instructions that a piece of work takes: exactly, on any x86-64 Linux, without counters of the processor and for any
// of its instructions. The trap flag makes it stop after each one, and the kernel sends SIGTRAP (some µs an
// instruction).
#include <signal.h>

#include <cstdint>

namespace eg::test {

inline volatile std::uint64_t trapped = 0;

inline void count_trap(int) { trapped = trapped + 1; }

/// The flags are changed below the red zone of the stack.
#define EG_TRAP_FLAG(change)                                                                             \
  __asm__ volatile("lea -128(%%rsp), %%rsp\n\tpushfq\n\t" change "\n\tpopfq\n\tlea 128(%%rsp), %%rsp" :: \
                       : "cc", "memory")

/// Of `work`, run by this thread alone.
template <class Work>
std::uint64_t instructions_of(Work&& work) {
  struct sigaction action {
  }, before{};
  action.sa_handler = count_trap;
  sigaction(SIGTRAP, &action, &before);
  trapped = 0;
  EG_TRAP_FLAG("orq $0x100, (%%rsp)");
  work();
  EG_TRAP_FLAG("andq $~0x100, (%%rsp)");
  sigaction(SIGTRAP, &before, nullptr);
  return trapped;
}

#undef EG_TRAP_FLAG

}  // namespace eg::test
