#pragma once
// How pair loops add to grains from several threads with the same result for any number of them: a chunk of grains owns
// its rows of the accumulator; what it adds to grains of other chunks goes to rows of its own ("halo"), which are added
// in a fixed order afterwards.
#include <omp.h>

#include <cstddef>
#include <span>
#include <vector>

#include "base/vec.hpp"

namespace eg {

struct Schedule {
  std::vector<Index> target;        ///< accumulator row of side j, one a pair; side i's row is i itself
  std::vector<Index> halo_begin;    ///< halo rows of chunk k: [halo_begin[k], halo_begin[k+1])
  std::vector<Index> gather_begin;  ///< entries of chunk k: [gather_begin[k], gather_begin[k+1]), sorted by grain
  std::vector<Index> gather_grain;  ///< grain of an entry, and the halo row to add to it
  std::vector<Index> gather_row;
  std::vector<Index> first_source;        ///< first chunk with a pair whose j lies in chunk k (k itself if none)
  std::vector<std::uint64_t> pair_begin;  ///< pairs of chunk k: [pair_begin[k], pair_begin[k+1])
  std::size_t grains = 0;

  std::size_t rows() const { return grains + gather_row.size(); }
  std::size_t chunks() const { return halo_begin.empty() ? 0 : halo_begin.size() - 1; }
  /// Thread t of so many has the chunks [first_chunk(t, threads), first_chunk(t + 1, threads)): about as many pairs as
  /// the others. Chunks with the same number of grains have the fewer pairs the later they come.
  std::size_t first_chunk(std::size_t thread, std::size_t threads) const;
};

/// Within a parallel region: `work(chunk)` for every chunk, and `after(chunk)` as soon as all pairs of its grains are
/// done, while they are at hand: pairs reach grains of later chunks only, so a chunk's grains have all they get once it
/// is done, unless another thread's chunk adds to them.
template <class Work, class After>
void run_chunks(const Schedule& schedule, Work&& work, After&& after) {
  const auto thread = static_cast<std::size_t>(omp_get_thread_num());
  const auto threads = static_cast<std::size_t>(omp_get_num_threads());
  const std::size_t first = schedule.first_chunk(thread, threads), end = schedule.first_chunk(thread + 1, threads);
  for (std::size_t k = first; k < end; ++k) {
    work(k);
    if (schedule.first_source[k] >= first) after(k);
  }
#pragma omp barrier
  // What waited is shared out anew: it is most chunks of the last thread and none of the first.
  std::size_t turn = 0;
  for (std::size_t t = 1; t < threads; ++t) {
    const std::size_t low = schedule.first_chunk(t, threads), high = schedule.first_chunk(t + 1, threads);
    for (std::size_t k = low; k < high; ++k)
      if (schedule.first_source[k] < low && turn++ % threads == thread) after(k);
  }
}

/// Pairs sorted by i, in chunks of `chunk` grains; `chunk_begin` as in Contacts. O(pairs).
void make_schedule(Schedule& out, std::size_t grains, std::size_t chunk, std::span<const Index> j,
                   std::span<const std::uint64_t> chunk_begin);

}  // namespace eg
