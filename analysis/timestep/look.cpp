#include "timestep/look.hpp"

#include "timestep/presser.hpp"

namespace eg {
namespace {

constexpr std::size_t chunk = Contacts::chunk;
constexpr double cold = 0.95;  // of the bound: grains below need not be known closely

/// Wall contacts by the chunk of their grain.
struct ByChunk {
  std::vector<std::uint32_t> begin, wall;

  ByChunk(const State& state, std::size_t chunks) : begin(chunks + 1), wall(state.wall_contacts.size()) {
    for (const auto& w : state.wall_contacts) ++begin[w.grain / chunk + 1];
    for (std::size_t k = 0; k < chunks; ++k) begin[k + 1] += begin[k];
    std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
    for (std::size_t w = 0; w < wall.size(); ++w)
      wall[next[state.wall_contacts[w].grain / chunk]++] = static_cast<std::uint32_t>(w);
  }
};

void gather(const Schedule& schedule, std::size_t k, AlignedVector<GrainSums>& rows) {
  for (Index e = schedule.gather_begin[k]; e < schedule.gather_begin[k + 1]; ++e) {
    GrainSums &to = rows[schedule.gather_grain[e]], &from = rows[schedule.gather_row[e]];
    to.block.first += from.block.first, to.block.second += from.block.second, to.play += from.play;
    from = {};
  }
}

/// Bounds of the grains [first, end), a multiple of eight or the last ones; those that do not fit are added to `open`.
void bound_grains(const Look& look, std::size_t first, std::size_t end, State& state, std::vector<Index>& open) {
  StandingBound& bound = state.policy.bound;
  for (std::size_t eight = first; eight < end; eight += 8) {
    const std::size_t last = std::min(end, eight + 8);
    const EightBounds found = bound_eight(state, look.rows, eight, last, look.terms, cold * bound.value);
    const Batch sum = found.high + found.play;
    for (std::size_t g = eight; g < last; ++g) {
      bound.grain[g] = sum[g - eight];
      if (!(sum[g - eight] > bound.value)) continue;
      const auto grain = static_cast<Index>(g);
      if (!block_is_below(block_of(state, look.rows, grain), look.terms, bound.value - found.play[g - eight]))
        open.push_back(grain);
    }
  }
}

/// Half of the mean.
double usual_overlap(const AlignedVector<AllowedSums>& chunks) {
  double reach = 0, count = 0;
  for (const AllowedSums& some : chunks) reach += sum(some.reach), count += sum(some.count);
  return count > 0 ? 0.5 * reach / count : 0.0;
}

}  // namespace

void look_at_all(const Scene& scene, State& state, const PressOptions& options, const Schedule& schedule, Look& out) {
  StandingBound& bound = state.policy.bound;
  const auto& list = state.contacts;
  const std::size_t grains = state.grains.size(), chunks = (grains + chunk - 1) / chunk;
  const bool pairs = schedule.chunks() > 0;
  out.outran.resize(list.size() + state.wall_contacts.size());
  out.terms = 2 * out.outran.size();
  if (out.grains.size() != grains) out.rows.clear();  // rows beyond the grains are zero
  out.rows.resize(std::max(schedule.rows(), grains));
  out.grains.resize(grains), bound.grain.resize(grains);
  out.allowed.assign(chunks, {});
  const ByChunk walls(state, chunks);
  std::vector<std::vector<Index>> open(chunks);
  with_law(scene.contact.law, [&]<class Law>(Law) {
    presser::Presser<Law> presser(scene, state, options);
    const auto add = [&](std::size_t k) {
      for (std::size_t g = k * chunk; g < std::min(grains, (k + 1) * chunk); ++g) out.rows[g] = {};
      for (std::size_t w = walls.begin[k]; w < walls.begin[k + 1]; ++w) presser.add_wall(walls.wall[w], bound, out);
      if (!pairs) return;
      for (std::size_t c = list.chunk_begin[k]; c < list.chunk_begin[k + 1]; c += Contacts::lanes)
        presser.add(c, bound, schedule, out, out.allowed[k]);
    };
    const auto finish = [&](std::size_t k) {
      if (pairs) gather(schedule, k, out.rows);
      bound_grains(out, k * chunk, std::min(grains, (k + 1) * chunk), state, open[k]);
    };
#pragma omp parallel if (chunks >= Contacts::worth_threads)
    {
      presser.prepare(out.grains);
      if (pairs) run_chunks(schedule, add, finish);
    }
    if (!pairs)
      for (std::size_t k = 0; k < chunks; ++k) add(k), finish(k);
  });
  bound.usual = usual_overlap(out.allowed);
  out.open.clear();
  for (const auto& some : open) out.open.insert(out.open.end(), some.begin(), some.end());
}

}  // namespace eg
