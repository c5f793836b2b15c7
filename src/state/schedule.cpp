#include "state/schedule.hpp"

#include <algorithm>

namespace eg {

std::size_t Schedule::first_chunk(std::size_t thread, std::size_t threads) const {
  if (thread == threads) return chunks();
  const std::uint64_t wanted = pair_begin.back() * thread / threads;
  const auto at = std::ranges::lower_bound(pair_begin, wanted) - pair_begin.begin();
  const bool back = at > 0 && wanted - pair_begin[at - 1] < pair_begin[at] - wanted;
  return static_cast<std::size_t>(at - back);
}

void make_schedule(Schedule& out, std::size_t grains, std::size_t chunk, std::span<const Index> j,
                   std::span<const std::uint64_t> chunk_begin) {
  const std::size_t chunks = chunk_begin.size() - 1;
  out.pair_begin.assign(chunk_begin.begin(), chunk_begin.end());
  out.grains = grains;
  out.target.assign(j.begin(), j.end());
  out.halo_begin.assign(1, static_cast<Index>(grains));

  std::vector<Index> owner;                     // grain of each halo row
  std::vector<Index> row_of(grains, no_index);  // its row within the chunk under way
  for (std::size_t k = 0; k < chunks; ++k) {
    const std::size_t low = k * chunk, high = std::min(grains, low + chunk), first = owner.size();
    for (std::size_t c = chunk_begin[k]; c < chunk_begin[k + 1]; ++c) {
      const Index grain = j[c];
      if (grain >= low && grain < high) continue;
      if (row_of[grain] == no_index) {
        row_of[grain] = static_cast<Index>(grains + owner.size());
        owner.push_back(grain);
      }
      out.target[c] = row_of[grain];
    }
    for (std::size_t h = first; h < owner.size(); ++h) row_of[owner[h]] = no_index;
    out.halo_begin.push_back(static_cast<Index>(grains + owner.size()));
  }

  std::vector<Index> next(grains + 1, 0);  // counting sort of halo rows by their grain
  for (const Index grain : owner) ++next[grain + 1];
  for (std::size_t i = 0; i < grains; ++i) next[i + 1] += next[i];
  out.gather_begin.clear();
  for (std::size_t k = 0; k < chunks; ++k) out.gather_begin.push_back(next[std::min(grains, k * chunk)]);
  out.gather_begin.push_back(static_cast<Index>(owner.size()));
  out.gather_row.resize(owner.size()), out.gather_grain.resize(owner.size());
  for (std::size_t h = 0; h < owner.size(); ++h) {
    const Index at = next[owner[h]]++;
    out.gather_row[at] = static_cast<Index>(grains + h), out.gather_grain[at] = owner[h];
  }
}

}  // namespace eg
