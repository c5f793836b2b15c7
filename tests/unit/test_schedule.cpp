#include <gtest/gtest.h>

#include <atomic>

#include "state/schedule.hpp"

using namespace eg;

namespace {

/// A schedule of so many chunks of one grain each, with pairs that reach nobody else.
Schedule of_pairs(const std::vector<std::uint64_t>& pairs) {
  std::vector<std::uint64_t> begin(1, 0);
  std::vector<Index> j;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    begin.push_back(begin.back() + pairs[k]);
    j.insert(j.end(), pairs[k], static_cast<Index>(k));
  }
  Schedule s;
  make_schedule(s, pairs.size(), 1, j, begin);
  return s;
}

}  // namespace

TEST(Schedule, ThreadsShareAllChunksOnce) {
  for (const auto& pairs : std::vector<std::vector<std::uint64_t>>{
           {0, 0, 0}, {5}, {0, 3, 0, 0}, {9, 8, 7, 6, 5, 4, 3, 2, 1, 0}, {100, 1, 1, 1, 1}, {1, 1, 1, 100}}) {
    const Schedule s = of_pairs(pairs);
    for (std::size_t threads = 1; threads < 7; ++threads) {
      EXPECT_EQ(s.first_chunk(0, threads), 0);
      EXPECT_EQ(s.first_chunk(threads, threads), pairs.size());
      for (std::size_t t = 0; t < threads; ++t) EXPECT_LE(s.first_chunk(t, threads), s.first_chunk(t + 1, threads));
    }
  }
}

TEST(Schedule, SharesDifferByNoMoreThanOneChunk) {
  std::vector<std::uint64_t> pairs;
  for (std::uint64_t k = 0; k < 40; ++k) pairs.push_back(200 - 3 * k);
  const Schedule s = of_pairs(pairs);
  for (std::size_t threads = 1; threads < 9; ++threads)
    for (std::size_t t = 0; t < threads; ++t) {
      const std::uint64_t share = s.pair_begin[s.first_chunk(t + 1, threads)] - s.pair_begin[s.first_chunk(t, threads)];
      EXPECT_NEAR(static_cast<double>(share), static_cast<double>(s.pair_begin.back()) / static_cast<double>(threads),
                  200);
    }
}

/// Chunk k waits for chunk k − 3: whatever thread has it, both are done before it is finished.
TEST(Schedule, EveryChunkIsFinishedOnceAndAfterItsSources) {
  std::vector<std::uint64_t> begin(1, 0);
  std::vector<Index> j;
  constexpr std::size_t chunks = 12;
  for (std::size_t k = 0; k < chunks; ++k) {
    j.push_back(static_cast<Index>(std::min(chunks - 1, k + 3)));
    begin.push_back(j.size());
  }
  Schedule s;
  make_schedule(s, chunks, 1, j, begin);
  for (const int threads : {1, 2, 3, 5}) {
    std::array<std::atomic<int>, chunks> worked{}, finished{};
    std::atomic<int> early{0};
#pragma omp parallel num_threads(threads)
    run_chunks(
        s, [&](std::size_t k) { ++worked[k]; },
        [&](std::size_t k) {
          for (std::size_t source = 0; source <= k; ++source)
            early += (source == k || j[source] == k) && worked[source] == 0;
          ++finished[k];
        });
    EXPECT_EQ(early, 0) << threads;
    for (std::size_t k = 0; k < chunks; ++k) EXPECT_TRUE(worked[k] == 1 && finished[k] == 1) << threads << " " << k;
  }
}
