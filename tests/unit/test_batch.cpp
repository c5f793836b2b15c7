// Masks and selections of eight lanes against the same on single numbers: std::experimental::simd lost masked
// assignments with one of the compilers, so every build must show that it keeps ours.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/number.hpp"

namespace eg {
namespace {

using Lanes = std::array<double, Batch::lanes>;

/// Bit k of `pattern` decides lane k.
Lanes lanes_of_pattern(unsigned pattern, double yes, double no) {
  Lanes x{};
  for (std::size_t k = 0; k < x.size(); ++k) x[k] = (pattern >> k & 1 ? yes : no) + 0.25 * static_cast<double>(k);
  return x;
}

/// Eight numbers that the compiler cannot know.
__attribute__((noinline)) Batch load(const Lanes& x) { return load_lanes(x.data()); }

TEST(Batch, EveryMaskSelectsItsLanes) {
  const Lanes half = lanes_of_pattern(0, 0, 0);
  for (unsigned first = 0; first < 256; ++first) {
    const Lanes a = lanes_of_pattern(first, 1, -1);
    const Mask above = load(a) > load(half), below = load(a) < load(half);
    EXPECT_EQ(any(above), first != 0) << first;
    EXPECT_EQ(any(below), first != 255) << first;
    for (unsigned second = 0; second < 256; second += 5) {
      const Mask other = load(lanes_of_pattern(second, 1, -1)) > load(half);
      const Batch both = select(above & other, load(a), load(half)),
                  either = select(above | other, load(a), load(half)),
                  neither = select(!(above | other), load(a), load(half));
      for (std::size_t k = 0; k < Batch::lanes; ++k) {
        const bool p = first >> k & 1, q = second >> k & 1;
        EXPECT_EQ(lane(above, k), p);
        EXPECT_EQ(lane(!above, k), !p);
        EXPECT_EQ(both[k], p && q ? a[k] : half[k]);
        EXPECT_EQ(either[k], p || q ? a[k] : half[k]);
        EXPECT_EQ(neither[k], !p && !q ? a[k] : half[k]);
      }
    }
  }
}

TEST(Batch, ArithmeticIsThatOfEveryLane) {
  for (unsigned pattern = 0; pattern < 256; ++pattern) {
    const Lanes a = lanes_of_pattern(pattern, 1.5, -3), b = lanes_of_pattern(pattern * 77 % 256, -2, 4);
    const Batch x = load(a), y = load(b);
    for (std::size_t k = 0; k < Batch::lanes; ++k) {
      EXPECT_EQ((x + y)[k], a[k] + b[k]);
      EXPECT_EQ((x - y)[k], a[k] - b[k]);
      EXPECT_EQ((x * y)[k], a[k] * b[k]);
      EXPECT_EQ((x / y)[k], a[k] / b[k]);
      EXPECT_EQ((-x)[k], -a[k]);
      EXPECT_EQ(max(x, y)[k], std::max(a[k], b[k]));
      EXPECT_EQ(min(x, y)[k], std::min(a[k], b[k]));
      EXPECT_EQ(abs(x)[k], std::abs(a[k]));
      EXPECT_EQ(sqrt(abs(x))[k], std::sqrt(std::abs(a[k])));
    }
    EXPECT_NEAR(sum(x), a[0] + a[1] + a[2] + a[3] + a[4] + a[5] + a[6] + a[7], 1e-14);
    Lanes back{};
    store_lanes(back.data(), x);
    EXPECT_EQ(back, a);
  }
}

}  // namespace
}  // namespace eg
