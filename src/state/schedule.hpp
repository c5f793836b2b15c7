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
  std::vector<std::uint64_t> pair_begin;  ///< pairs of chunk k: [pair_begin[k], pair_begin[k+1])
  std::size_t grains = 0;

  std::size_t rows() const { return grains + gather_row.size(); }
  std::size_t chunks() const { return halo_begin.empty() ? 0 : halo_begin.size() - 1; }
  /// Thread t of so many has the chunks [first_chunk(t, threads), first_chunk(t + 1, threads)): about as many pairs as
  /// the others. Chunks with the same number of grains have the fewer pairs the later they come.
  std::size_t first_chunk(std::size_t thread, std::size_t threads) const;
};

/// Within a parallel region: `work(chunk)` for every chunk, and `after(chunk)` once all pairs of its grains are done. A
/// single thread goes on with it at once, while the grains are at hand: pairs reach grains of later chunks only.
/// Several wait for each other first and share it evenly: what the first could do at once, the last would have to wait
/// for.
template <class Work, class After>
void run_chunks(const Schedule& schedule, Work&& work, After&& after) {
  const auto thread = static_cast<std::size_t>(omp_get_thread_num());
  const auto threads = static_cast<std::size_t>(omp_get_num_threads());
  for (std::size_t k = schedule.first_chunk(thread, threads); k < schedule.first_chunk(thread + 1, threads); ++k) {
    work(k);
    if (threads == 1) after(k);
  }
  if (threads == 1) return;
#pragma omp barrier
  const std::size_t chunks = schedule.chunks();
  for (std::size_t k = chunks * thread / threads; k < chunks * (thread + 1) / threads; ++k) after(k);
}

/// Pairs sorted by i, in chunks of `chunk` grains; `chunk_begin` as in Contacts. O(pairs).
void make_schedule(Schedule& out, std::size_t grains, std::size_t chunk, std::span<const Index> j,
                   std::span<const std::uint64_t> chunk_begin);

}  // namespace eg
