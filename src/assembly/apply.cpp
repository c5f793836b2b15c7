#include "assembly/apply.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "contact/lanes.hpp"

namespace eg {

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
  u_.resize(grains_ + 1), turn_.resize(grains_ + 1);
  build_links(network);
  build_couples(network);
}

void StiffnessOperator::build_couples(const Network& network) {
  if (std::ranges::none_of(network.springs, &Spring::couple)) return;
  couple_begin_.assign(grains_ + 2, 0);
  const auto each_end = [&](auto use) {
    for (const Spring& s : network.springs) {
      if (!s.couple || s.i == s.j) continue;
      const Index j = s.j == no_index ? static_cast<Index>(grains_) : s.j;
      use(s.i, Couple{s.n, s.tangential, s.normal - s.tangential, j});
      if (s.j != no_index) use(s.j, Couple{s.n, s.tangential, s.normal - s.tangential, s.i});
    }
  };
  each_end([&](Index g, const Couple&) { ++couple_begin_[g + 2]; });
  for (std::size_t g = 2; g < couple_begin_.size(); ++g) couple_begin_[g] += couple_begin_[g - 1];
  couples_.resize(couple_begin_.back());
  each_end([&](Index g, const Couple& c) { couples_[couple_begin_[g + 1]++] = c; });
}

/// Couples of the springs of couples on one grain. Each spring is visited from both of its ends: no grain waits for
/// another.
Vec3 StiffnessOperator::couple_on(std::size_t grain) const {
  Vec3 sum;
  for (std::size_t k = couple_begin_[grain]; k < couple_begin_[grain + 1]; ++k) {
    const Couple& c = couples_[k];
    const Vec3 bend = turn_[grain].vec() - turn_[c.other].vec();
    sum += bend * c.rolling + c.n * (c.excess * dot(c.n, bend));
  }
  return sum;
}

void StiffnessOperator::build_links(const Network& network) {
  std::vector<std::size_t> order;
  for (std::size_t s = 0; s < network.springs.size(); ++s)
    if (!network.springs[s].couple) order.push_back(s);
  // The schedule wants the grain of the earlier chunk first: a spring numbered the other way is turned round.
  const auto low = [&](std::size_t c) { return std::min(network.springs[c].i, network.springs[c].j); };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return low(a) < low(b); });

  std::vector<std::uint64_t> chunk_begin{0};
  auto next = order.begin();
  for (std::size_t first = 0; first < grains_; first += chunk_grains) {
    const auto own = static_cast<Index>(first);
    for (std::size_t lane = 0; next != order.end() && low(*next) < first + chunk_grains; ++next, ++lane) {
      if (lane % lanes == 0) {
        links_.emplace_back();
        i_.resize(lanes * links_.size(), own), j_.resize(lanes * links_.size(), own);
      }
      Spring s = network.springs[*next];
      if (s.j < s.i) std::swap(s.i, s.j), std::swap(s.arm_i, s.arm_j), s.n = -s.n;
      Links& to = links_.back();
      const std::size_t k = lane % lanes, at = lanes * (links_.size() - 1) + k;
      i_[at] = s.i, j_[at] = s.j == no_index ? static_cast<Index>(grains_) : s.j;
      to.nx[k] = s.n.x, to.ny[k] = s.n.y, to.nz[k] = s.n.z;
      to.tangential[k] = s.tangential, to.excess[k] = s.normal - s.tangential;
      to.arm_i[k] = s.arm_i, to.arm_j[k] = s.arm_j;
    }
    chunk_begin.push_back(lanes * links_.size());
  }
  assert(next == order.end());
  make_schedule(schedule_, grains_ + 1, chunk_grains, j_, chunk_begin);  // the last "grain" takes what walls are given
  first_links_.clear();
  for (const auto c : chunk_begin) first_links_.push_back(c / lanes);
  sums_.assign(2 * schedule_.rows(), Quad{});
}

namespace {

using Loose4 = double __attribute__((vector_size(32), aligned(8)));

Double4 scaled(const double* entry, double scale) {
  return *reinterpret_cast<const Loose4*>(entry) * Double4{scale, scale, scale, 0};
}
void put(double* entry, Double4 v) { *reinterpret_cast<Loose4*>(entry) = v; }

}  // namespace

template <int... component>
void StiffnessOperator::load(std::size_t chunk, const double* x) const {
  const std::size_t low = chunk * chunk_grains, high = std::min(grains_, low + chunk_grains);
  std::size_t g = low;
  if constexpr (sizeof...(component) == 6)  // four entries at a time; a row's last three end within the next row
    for (; g + 1 < high; ++g) {
      reinterpret_cast<Double4&>(u_[g]) = scaled(x + 6 * g, scale_[g]);
      reinterpret_cast<Double4&>(turn_[g]) = scaled(x + 6 * g + 3, turn_scale_[g]);
    }
  for (; g < high; ++g) {
    double row[6] = {};
    const double* entry = x + g * sizeof...(component);
    ((row[component] = *entry++), ...);
    const double m = scale_[g], i = turn_scale_[g];
    u_[g] = {m * row[0], m * row[1], m * row[2], 0};
    turn_[g] = {i * row[3], i * row[4], i * row[5], 0};
  }
}

/// Adds the contacts of a chunk to `sums_`, which are zero before.
void StiffnessOperator::sum(std::size_t chunk) const {
  Quad* sums = sums_.data();
  for (std::size_t b = first_links_[chunk]; b < first_links_[chunk + 1]; ++b) {
    const Links& s = links_[b];
    const Index *i = &i_[lanes * b], *j = &j_[lanes * b], *to = &schedule_.target[lanes * b];
    const Vec<Batch> n{load_lanes(s.nx), load_lanes(s.ny), load_lanes(s.nz)};
    const Batch arm_i = load_lanes(s.arm_i), arm_j = load_lanes(s.arm_j);
    const auto turn_i = xyz(load_rows<Batch>(turn_.data(), i)), turn_j = xyz(load_rows<Batch>(turn_.data(), j));
    const Vec<Batch> relative =
        xyz(load_difference<Batch>(u_.data(), i, j)) + cross(n, turn_i * arm_i + turn_j * arm_j);
    const Vec<Batch> force = relative * load_lanes(s.tangential) + n * (load_lanes(s.excess) * dot(n, relative));
    add_contact<2, Batch>(sums, i, to, force, cross(force, n), s.arm_i, s.arm_j);
  }
}

/// Takes the sums of a chunk's grains, and leaves zeros.
template <int... component>
void StiffnessOperator::store(std::size_t chunk, double* y) const {
  const auto row = [this](std::size_t r) -> Double8& { return reinterpret_cast<Double8&>(sums_[2 * r]); };
  for (Index e = schedule_.gather_begin[chunk]; e < schedule_.gather_begin[chunk + 1]; ++e) {
    row(schedule_.gather_grain[e]) += row(schedule_.gather_row[e]);
    row(schedule_.gather_row[e]) = Double8{};
  }
  const std::size_t low = chunk * chunk_grains, high = std::min(grains_, low + chunk_grains);
  if (!couples_.empty())
    for (std::size_t g = low; g < high; ++g) sums_[2 * g + 1].set(sums_[2 * g + 1].vec() + couple_on(g));
  std::size_t g = low;
  if constexpr (sizeof...(component) == 6)
    for (; g + 1 < high; ++g) {
      put(y + 6 * g, reinterpret_cast<Double4&>(sums_[2 * g]) * scale_[g]);
      put(y + 6 * g + 3, reinterpret_cast<Double4&>(sums_[2 * g + 1]) * turn_scale_[g]);
      row(g) = Double8{};
    }
  for (; g < high; ++g) {
    const Vec3 u = sums_[2 * g].vec(), turn = sums_[2 * g + 1].vec();
    const double m = scale_[g], i = turn_scale_[g];
    const double values[6] = {m * u.x, m * u.y, m * u.z, i * turn.x, i * turn.y, i * turn.z};
    double* entry = y + g * sizeof...(component);
    ((*entry++ = values[component]), ...);
    row(g) = Double8{};
  }
}

template <int... component>
void StiffnessOperator::run(const double* x, double* y) const {
  const std::size_t chunks = schedule_.chunks();
#pragma omp parallel if (chunks >= 4)
  {
#pragma omp for schedule(static)
    for (std::size_t c = 0; c < chunks; ++c) load<component...>(c, x);
    run_chunks(
        schedule_, [&](std::size_t c) { sum(c); }, [&](std::size_t c) { store<component...>(c, y); });
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
