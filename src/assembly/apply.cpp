#include "assembly/apply.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "base/batch.hpp"

namespace eg {
namespace {

EG_INLINE Double4 vector_of(const Quad& q) { return *reinterpret_cast<const Double4*>(&q); }

/// Vectors of eight rows, component by component.
template <class Pick>
EG_INLINE Vec<Batch> columns(Pick row) {
  const auto c = transpose_rows(row(0), row(1), row(2), row(3), row(4), row(5), row(6), row(7));
  return {c.x, c.y, c.z};
}

EG_INLINE void add(Quad& to, Double4 v) { *reinterpret_cast<Double4*>(&to) += v; }

}  // namespace

StiffnessOperator::StiffnessOperator(const Network& network, Scaling scaling)
    : grains_(network.size()),
      width_(static_cast<std::size_t>(network.dofs_per_grain())),
      solid_(network.dimension == 3),
      rotation_(network.rotation),
      scale_(grains_, 1.0),
      turn_scale_(grains_, 1.0) {
  if (scaling == Scaling::mass)
    for (std::size_t g = 0; g < grains_; ++g) {
      scale_[g] = std::sqrt(network.inverse_mass[g]);
      if (rotation_) turn_scale_[g] = std::sqrt(network.inverse_inertia[g]);
    }
  rows_.resize(grains_ + 1);
  build_chunks(network);
}

void StiffnessOperator::add_link(const Spring& s, std::size_t lane, Index j, Index sum_j) {
  Links& to = links_.back();
  to.nx[lane] = s.n.x, to.ny[lane] = s.n.y, to.nz[lane] = s.n.z;
  to.tangential[lane] = s.tangential, to.excess[lane] = s.normal - s.tangential;
  to.arm_i[lane] = s.arm_i, to.arm_j[lane] = s.arm_j;
  to.i[lane] = s.i, to.j[lane] = j, to.sum_j[lane] = sum_j;
}

void StiffnessOperator::build_chunks(const Network& network) {
  std::vector<std::size_t> order(network.springs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return network.springs[a].i < network.springs[b].i; });

  std::vector<std::vector<std::uint32_t>> halo(grains_);
  constexpr auto none = ~std::uint32_t{0};
  std::vector<std::uint32_t> sum_of(grains_ + 1, none);  // of the chunk under way
  std::uint32_t sums = 0;
  auto next = order.begin();
  for (std::size_t first = 0; first < grains_; first += chunk_grains) {
    const std::size_t last = std::min(first + chunk_grains, grains_);
    chunks_.push_back({first, links_.size(), sums});
    for (std::size_t g = first; g < last; ++g) sum_of[g] = sums++;
    std::vector<Index> foreign;
    for (std::size_t lane = 0; next != order.end() && network.springs[*next].i < last;
         ++next, lane = (lane + 1) % lanes) {
      const Spring& s = network.springs[*next];
      const Index j = s.j == no_index ? static_cast<Index>(grains_) : s.j;
      if (sum_of[j] == none) {
        sum_of[j] = sums++;
        foreign.push_back(j);
        if (j < grains_) halo[j].push_back(sum_of[j]);
      }
      if (lane == 0) {
        links_.emplace_back();
        for (std::size_t l = 0; l < lanes; ++l) add_link({}, l, 0, sum_of[first]), links_.back().i[l] = Index(first);
      }
      add_link(s, lane, j, sum_of[j]);
    }
    for (const Index j : foreign) sum_of[j] = none;
    for (std::size_t g = first; g < last; ++g) sum_of[g] = none;
  }
  assert(next == order.end());
  chunks_.push_back({grains_, links_.size(), sums});
  sums_.resize(sums);
  halo_begin_.push_back(0);
  for (const auto& list : halo) {
    halo_sum_.insert(halo_sum_.end(), list.begin(), list.end());
    halo_begin_.push_back(static_cast<std::uint32_t>(halo_sum_.size()));
  }
}

template <int... component>
void StiffnessOperator::load(std::size_t chunk, const double* x) const {
  for (std::size_t g = chunks_[chunk].first_grain; g < chunks_[chunk + 1].first_grain; ++g) {
    double row[6] = {};
    const double* entry = x + g * sizeof...(component);
    ((row[component] = *entry++), ...);
    const double m = scale_[g], i = turn_scale_[g];
    rows_[g] = {{m * row[0], m * row[1], m * row[2], 0}, {i * row[3], i * row[4], i * row[5], 0}};
  }
}

void StiffnessOperator::sum(std::size_t chunk) const {
  const Chunk &begin = chunks_[chunk], &end = chunks_[chunk + 1];
  std::fill(sums_.begin() + static_cast<std::ptrdiff_t>(begin.first_sum),
            sums_.begin() + static_cast<std::ptrdiff_t>(end.first_sum), Row{});
  const Row* rows = rows_.data();
  Row* sums = sums_.data();
  Row* own = sums + (begin.first_sum - begin.first_grain);  // halo rows only add: never before the array
  constexpr std::size_t ahead = 4;                          // blocks between a prefetch and its use
  for (std::size_t b = begin.first_links; b < end.first_links; ++b) {
    const Links& s = links_[b];
    if (b + ahead < end.first_links) {
      const Links& later = links_[b + ahead];
      for (std::size_t k = 0; k < lanes; ++k) {
        __builtin_prefetch(rows + later.j[k]);
        __builtin_prefetch(sums + later.sum_j[k], 1);
      }
    }
    const Vec<Batch> n{load_lanes(s.nx), load_lanes(s.ny), load_lanes(s.nz)};
    const Batch arm_i = load_lanes(s.arm_i), arm_j = load_lanes(s.arm_j);
    const auto u_i = columns([&](int k) { return vector_of(rows[s.i[k]].u); });
    const auto u_j = columns([&](int k) { return vector_of(rows[s.j[k]].u); });
    const auto turn_i = columns([&](int k) { return vector_of(rows[s.i[k]].turn); });
    const auto turn_j = columns([&](int k) { return vector_of(rows[s.j[k]].turn); });
    const Vec<Batch> relative = u_j - u_i + cross(n, turn_i * arm_i + turn_j * arm_j);
    const Vec<Batch> force = relative * load_lanes(s.tangential) + n * (load_lanes(s.excess) * dot(n, relative));
    const Vec<Batch> moment = cross(force, n);  // of unit arm, on either grain
    const Batch zero(0.0);
    Double4 f[8], m_i[8], m_j[8];
    transpose_columns({force.x, force.y, force.z, zero}, f);
    transpose_columns({moment.x * arm_i, moment.y * arm_i, moment.z * arm_i, zero}, m_i);
    transpose_columns({moment.x * arm_j, moment.y * arm_j, moment.z * arm_j, zero}, m_j);
    for (std::size_t k = 0; k < lanes; ++k) {
      add(own[s.i[k]].u, -f[k]);
      add(own[s.i[k]].turn, m_i[k]);
      add(sums[s.sum_j[k]].u, f[k]);
      add(sums[s.sum_j[k]].turn, m_j[k]);
    }
  }
}

template <int... component>
void StiffnessOperator::store(std::size_t chunk, double* y) const {
  const std::size_t first = chunks_[chunk].first_grain;
  for (std::size_t g = first; g < chunks_[chunk + 1].first_grain; ++g) {
    Row total = sums_[chunks_[chunk].first_sum + g - first];
    for (auto h = halo_begin_[g]; h < halo_begin_[g + 1]; ++h) {
      add(total.u, vector_of(sums_[halo_sum_[h]].u));
      add(total.turn, vector_of(sums_[halo_sum_[h]].turn));
    }
    const double m = scale_[g], i = turn_scale_[g];
    const double row[6] = {m * total.u.x,    m * total.u.y,    m * total.u.z,
                           i * total.turn.x, i * total.turn.y, i * total.turn.z};
    double* entry = y + g * sizeof...(component);
    ((*entry++ = row[component]), ...);
  }
}

template <int... component>
void StiffnessOperator::run(const double* x, double* y) const {
  const std::size_t chunks = chunks_.size() - 1;
#pragma omp parallel if (chunks > 1)
  {
#pragma omp for schedule(static)
    for (std::size_t c = 0; c < chunks; ++c) load<component...>(c, x);
#pragma omp for schedule(static)
    for (std::size_t c = 0; c < chunks; ++c) sum(c);
#pragma omp for schedule(static)
    for (std::size_t c = 0; c < chunks; ++c) store<component...>(c, y);
  }
}

void StiffnessOperator::apply(std::span<const double> x, std::span<double> y) const {
  assert(x.size() == rows() && y.size() == rows());
  if (solid_ && rotation_) run<0, 1, 2, 3, 4, 5>(x.data(), y.data());
  if (solid_ && !rotation_) run<0, 1, 2>(x.data(), y.data());
  if (!solid_ && rotation_) run<0, 1, 5>(x.data(), y.data());
  if (!solid_ && !rotation_) run<0, 1>(x.data(), y.data());
}

}  // namespace eg
