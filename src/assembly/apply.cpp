#include "assembly/apply.hpp"

#include <omp.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "base/transpose.hpp"

namespace eg {

StiffnessOperator::StiffnessOperator(const Network& network, Scaling scaling)
    : grains_(network.size()),
      width_(static_cast<std::size_t>(network.dofs_per_grain())),
      solid_(network.dimension == 3),
      rotation_(network.rotation),
      scale_(grains_, {1.0, 1.0}) {
  if (scaling == Scaling::mass)
    for (std::size_t g = 0; g < grains_; ++g)
      scale_[g] = {std::sqrt(network.inverse_mass[g]), rotation_ ? std::sqrt(network.inverse_inertia[g]) : 1.0};
  build_links(network);
  build_couples(network);
}

void StiffnessOperator::build_couples(const Network& network) {
  if (std::ranges::none_of(network.springs, &Spring::couple)) return;
  couple_begin_.assign(grains_ + 2, 0);
  const auto each_end = [&](auto use) {
    for (const Spring& s : network.springs) {
      if (!s.couple || s.i == s.j) continue;
      use(s.i, Couple{s.n, s.tangential, s.normal - s.tangential, s.j});
      if (s.j != no_index) use(s.j, Couple{s.n, s.tangential, s.normal - s.tangential, s.i});
    }
  };
  each_end([&](Index g, const Couple&) { ++couple_begin_[g + 2]; });
  for (std::size_t g = 2; g < couple_begin_.size(); ++g) couple_begin_[g] += couple_begin_[g - 1];
  couples_.resize(couple_begin_.back());
  each_end([&](Index g, const Couple& c) { couples_[couple_begin_[g + 1]++] = c; });
}

/// Springs by their lower grain, so that a chunk reaches later ones only; but of a few grains at a time first one of
/// each, then the second ones, … : to add to one row twice in a row is to wait for the first sum on its way to memory.
static std::vector<std::size_t> spring_order(const Network& network) {
  constexpr Index few = 32;
  struct Place {
    Index group, turn, grain;
    std::size_t spring;
    auto operator<=>(const Place&) const = default;
  };
  std::vector<Place> places;
  std::vector<Index> turns(network.size(), 0);
  for (std::size_t s = 0; s < network.springs.size(); ++s) {
    const Spring& spring = network.springs[s];
    if (spring.couple) continue;
    const Index low = std::min(spring.i, spring.j);  // a wall is the last of all
    places.push_back({low / few, turns[low]++, low, s});
  }
  std::ranges::sort(places);
  std::vector<std::size_t> order;
  for (const Place& p : places) order.push_back(p.spring);
  return order;
}

void StiffnessOperator::build_links(const Network& network) {
  const std::vector<std::size_t> order = spring_order(network);
  const auto low = [&](std::size_t c) { return std::min(network.springs[c].i, network.springs[c].j); };
  std::vector<Index> row_of(grains_, no_index);  // in the halo of the chunk under way
  auto next = order.begin();
  for (std::size_t first = 0; first < grains_; first += chunk_grains) {
    const std::size_t own = std::min(chunk_grains, grains_ - first), first_halo = halo_.size();
    chunks_.push_back({links_.size(), first_halo});
    const auto row = [&](Index g) {
      if (g == no_index) return static_cast<Index>(own);
      if (g < first + own) return static_cast<Index>(g - first);
      if (row_of[g] == no_index) {
        row_of[g] = static_cast<Index>(own + 1 + halo_.size() - first_halo);
        halo_.push_back(g);
      }
      return row_of[g];
    };
    for (std::size_t lane = 0; next != order.end() && low(*next) < first + own; ++next, ++lane) {
      const std::size_t k = lane % lanes;
      if (k == 0) links_.emplace_back();
      Spring s = network.springs[*next];
      if (s.j < s.i) std::swap(s.i, s.j), std::swap(s.arm_i, s.arm_j), s.n = -s.n;
      Links& to = links_.back();
      to.i[k] = row(s.i), to.j[k] = row(s.j);
      to.nx[k] = s.n.x, to.ny[k] = s.n.y, to.nz[k] = s.n.z;
      to.tangential[k] = s.tangential, to.excess[k] = s.normal - s.tangential;
      to.arm_i[k] = s.arm_i, to.arm_j[k] = s.arm_j;
    }
    for (std::size_t h = first_halo; h < halo_.size(); ++h) row_of[halo_[h]] = no_index;
    most_rows_ = std::max(most_rows_, own + 1 + halo_.size() - first_halo);
  }
  assert(next == order.end());
  chunks_.push_back({links_.size(), halo_.size()});
}

template <int... component>
struct StiffnessOperator::Entries {
  static constexpr std::size_t width = sizeof...(component);

  static Double8 load(const double* x, std::size_t g) {
    Double8 row{};
    const double* entry = x + g * width;
    ((row[component < 3 ? component : component + 1] = *entry++), ...);
    return row;
  }
  static void store(double* y, std::size_t g, Double8 row) {
    double* entry = y + g * width;
    ((*entry++ = row[component < 3 ? component : component + 1]), ...);
  }
};

/// Two overlapping fours; what they bring along is not used.
template <>
struct StiffnessOperator::Entries<0, 1, 2, 3, 4, 5> {
  // a typedef: in an alias clang 14 forgets that fours need not be aligned
  typedef double Loose4 __attribute__((vector_size(32), aligned(8)));

  static EG_INLINE Double8 load(const double* x, std::size_t g) {
    const Double4 a = *reinterpret_cast<const Loose4*>(x + 6 * g), b = *reinterpret_cast<const Loose4*>(x + 6 * g + 2);
    return join(a, __builtin_shufflevector(b, b, 1, 2, 3, 0));
  }
  static EG_INLINE void store(double* y, std::size_t g, Double8 row) {
    *reinterpret_cast<Loose4*>(y + 6 * g) = __builtin_shufflevector(row, row, 0, 1, 2, 3);
    *reinterpret_cast<Loose4*>(y + 6 * g + 2) = __builtin_shufflevector(row, row, 2, 4, 5, 6);
  }
};

/// Couples of the springs of couples on one grain. Each spring is visited from both of its ends: no grain waits for
/// another.
template <class Rows>
Vec3 StiffnessOperator::couple_on(std::size_t grain, const double* x) const {
  const auto turn = [&](Index g) {
    if (g == no_index) return Vec3{};
    const Double8 row = Rows::load(x, g) * scale(g);
    return Vec3{row[4], row[5], row[6]};
  };
  const Vec3 own = turn(static_cast<Index>(grain));
  Vec3 sum;
  for (std::size_t k = couple_begin_[grain]; k < couple_begin_[grain + 1]; ++k) {
    const Couple& c = couples_[k];
    const Vec3 bend = own - turn(c.other);
    sum += bend * c.rolling + c.n * (c.excess * dot(c.n, bend));
  }
  return sum;
}

/// Adds what the springs of a chunk exert.
void StiffnessOperator::sum(std::size_t chunk, const Double8* motion, Double8* force) const {
  for (std::size_t b = chunks_[chunk].first_link; b < chunks_[chunk + 1].first_link; ++b) {
    const Links& s = links_[b];
    Double8 row[lanes];  // u_j − u_i | a_i θ_i + a_j θ_j
    for (std::size_t k = 0; k < lanes; ++k)
      row[k] = motion[s.i[k]] * halves(-1, s.arm_i[k]) + motion[s.j[k]] * halves(1, s.arm_j[k]);
    Vec<Batch> relative, turn;
    transpose_rows(row, relative, turn);
    const Vec<Batch> n{load_lanes(s.nx), load_lanes(s.ny), load_lanes(s.nz)};
    relative += cross(n, turn);
    const Vec<Batch> f = relative * load_lanes(s.tangential) + n * (load_lanes(s.excess) * dot(n, relative));
    transpose_columns(f, cross(f, n), row);
    for (std::size_t k = 0; k < lanes; ++k) {
      force[s.i[k]] += row[k] * halves(-1, s.arm_i[k]);
      force[s.j[k]] += row[k] * halves(1, s.arm_j[k]);
    }
  }
}

/// Grains from `end` on are another thread's: what they get waits.
template <class Rows>
void StiffnessOperator::run_chunk(std::size_t chunk, std::size_t end, const double* x, double* y,
                                  Scratch& scratch) const {
  const std::size_t first = chunk * chunk_grains, own = std::min(chunk_grains, grains_ - first);
  const std::size_t halo_begin = chunks_[chunk].first_halo, halo = chunks_[chunk + 1].first_halo - halo_begin;
  Double8 *motion = scratch.motion.data(), *force = scratch.force.data();
  for (std::size_t r = 0; r < own; ++r) motion[r] = Rows::load(x, first + r) * scale(first + r);
  motion[own] = Double8{};
  for (std::size_t h = 0; h < halo; ++h) {
    const Index g = halo_[halo_begin + h];
    motion[own + 1 + h] = Rows::load(x, g) * scale(g);
  }
  sum(chunk, motion, force);
  for (std::size_t r = 0; r < own; ++r) {
    if (!couples_.empty()) {
      const Vec3 couple = couple_on<Rows>(first + r, x);
      force[r] += Double8{0, 0, 0, 0, couple.x, couple.y, couple.z, 0};
    }
    Rows::store(y, first + r, force[r] * scale(first + r));
    force[r] = Double8{};
  }
  force[own] = Double8{};
  for (std::size_t h = 0; h < halo; ++h) {
    const Index g = halo_[halo_begin + h];
    const Double8 felt = force[own + 1 + h] * scale(g);
    force[own + 1 + h] = Double8{};
    if (g < end)
      Rows::store(y, g, Rows::load(y, g) + felt);
    else
      scratch.late.push_back({felt, g});
  }
}

template <class Rows>
void StiffnessOperator::run(const double* x, double* y) const {
  const std::size_t chunks = chunks_.size() - 1;
  scratch_.resize(std::max(scratch_.size(), static_cast<std::size_t>(omp_get_max_threads())));
#pragma omp parallel if (chunks >= 4)
  {
    const auto thread = static_cast<std::size_t>(omp_get_thread_num());
    const auto threads = static_cast<std::size_t>(omp_get_num_threads());
    const auto first_chunk = [&](std::size_t t) { return chunks * t / threads; };
    const std::size_t begin = first_chunk(thread) * chunk_grains, end = first_chunk(thread + 1) * chunk_grains;
    Scratch& own = scratch_[thread];
    own.motion.resize(most_rows_), own.force.resize(most_rows_);
    own.late.clear();
    for (std::size_t k = first_chunk(thread + 1); k-- > first_chunk(thread);) run_chunk<Rows>(k, end, x, y, own);
#pragma omp barrier
    for (std::size_t t = thread; t-- > 0;)
      for (const Late& l : scratch_[t].late)
        if (l.grain >= begin && l.grain < end) Rows::store(y, l.grain, Rows::load(y, l.grain) + l.row);
  }
}

void StiffnessOperator::apply(std::span<const double> x, std::span<double> y) const {
  assert(x.size() == rows() && y.size() == rows());
  if (solid_ && rotation_) run<Entries<0, 1, 2, 3, 4, 5>>(x.data(), y.data());
  if (solid_ && !rotation_) run<Entries<0, 1, 2>>(x.data(), y.data());
  if (!solid_ && rotation_) run<Entries<0, 1, 5>>(x.data(), y.data());
  if (!solid_ && !rotation_) run<Entries<0, 1>>(x.data(), y.data());
}

}  // namespace eg
