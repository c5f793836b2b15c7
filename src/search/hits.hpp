#pragma once
// Masks of eight lanes as bits, to visit those that are set.
#include <array>
#include <bit>

#include "base/batch.hpp"

namespace eg {

/// Lane k as bit k.
inline unsigned bits(Mask m) {
  if constexpr (sizeof(Mask) == 1) return std::bit_cast<std::array<std::uint8_t, sizeof(Mask)>>(m)[0];
  unsigned all = 0;
  for (std::size_t k = 0; k < Batch::lanes; ++k) all |= lane(m, k) ? 1u << k : 0u;
  return all;
}

/// Calls f(k) for the lanes k < count that are set, in order.
template <class F>
EG_INLINE void visit_hits(Mask m, std::size_t count, F&& f) {
  unsigned hits = bits(m);
  if (count < Batch::lanes) hits &= (1u << count) - 1;
  for (; hits != 0; hits &= hits - 1) f(static_cast<std::size_t>(std::countr_zero(hits)));
}

}  // namespace eg
