#pragma once
// Arrays on cache-line boundaries, or on huge pages when they are large (fewer misses of the translation cache).
#include <sys/mman.h>

#include <cstdint>
#include <cstdlib>
#include <new>
#include <vector>

namespace eg {

template <class T>
struct AlignedAllocator {
  using value_type = T;
  static constexpr std::size_t line = 64, huge = std::size_t{2} << 20;

  AlignedAllocator() = default;
  template <class U>
  AlignedAllocator(const AlignedAllocator<U>&) {}

  T* allocate(std::size_t n) {
    if (n > static_cast<std::size_t>(PTRDIFF_MAX) / (2 * sizeof(T))) throw std::bad_alloc();
    const std::size_t unit = n * sizeof(T) >= huge ? huge : line;
    const std::size_t bytes = (n * sizeof(T) + unit - 1) / unit * unit;
    void* p = std::aligned_alloc(unit, bytes);
    if (!p) throw std::bad_alloc();
    if (unit == huge) ::madvise(p, bytes, MADV_HUGEPAGE);
    return static_cast<T*>(p);
  }
  void deallocate(T* p, std::size_t) { std::free(p); }
  friend bool operator==(const AlignedAllocator&, const AlignedAllocator&) { return true; }
};

template <class T>
using AlignedVector = std::vector<T, AlignedAllocator<T>>;

}  // namespace eg
