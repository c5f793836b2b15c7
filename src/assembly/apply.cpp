#include "assembly/apply.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "assembly/stiffness.hpp"

namespace eg {

StiffnessOperator::StiffnessOperator(const Network& network, Scaling scaling)
    : grains_(network.size()), width_(static_cast<std::size_t>(network.dofs_per_grain())) {
  const auto components = active_components(network);
  components_.assign(components.begin(), components.end());
  scale_.assign(grains_, 1.0);
  turn_scale_.assign(grains_, 1.0);
  if (scaling == Scaling::mass)
    for (std::size_t g = 0; g < grains_; ++g) {
      scale_[g] = std::sqrt(network.inverse_mass[g]);
      if (network.rotation) turn_scale_[g] = std::sqrt(network.inverse_inertia[g]);
    }
  rows_.resize(grains_ + 1);
  build_chunks(network);
}

void StiffnessOperator::build_chunks(const Network& network) {
  const std::size_t count = (grains_ + chunk_grains - 1) / chunk_grains;
  std::vector<std::size_t> order(network.springs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return network.springs[a].i < network.springs[b].i; });

  std::vector<std::vector<std::uint32_t>> halo(grains_);  // rows of sums of other chunks, a grain
  constexpr auto none = ~std::uint32_t{0};
  std::vector<std::uint32_t> row_of(grains_ + 1, none);  // of the chunk under way
  std::uint32_t sums = 0;
  auto next = order.begin();
  for (std::size_t c = 0; c < count; ++c) {
    const std::size_t first = c * chunk_grains, last = std::min(first + chunk_grains, grains_);
    chunks_.push_back({links_.size(), sums});
    for (std::size_t g = first; g < last; ++g) row_of[g] = sums++;
    std::vector<Index> foreign;
    for (; next != order.end() && network.springs[*next].i < last; ++next) {
      const Spring& s = network.springs[*next];
      const Index j = s.j == no_index ? static_cast<Index>(grains_) : s.j;
      if (row_of[j] == none) {
        row_of[j] = sums++;
        foreign.push_back(j);
        if (j < grains_) halo[j].push_back(row_of[j]);
      }
      links_.push_back({s.n, s.normal, s.tangential, s.arm_i, s.arm_j, s.i, j, row_of[s.i], row_of[j]});
    }
    for (const Index j : foreign) row_of[j] = none;
    for (std::size_t g = first; g < last; ++g) {
      halo[g].insert(halo[g].begin(), row_of[g]);
      row_of[g] = none;
    }
  }
  assert(next == order.end());
  chunks_.push_back({links_.size(), sums});
  sums_.resize(sums);
  halo_begin_.push_back(0);
  for (const auto& list : halo) {
    halo_sum_.insert(halo_sum_.end(), list.begin(), list.end());
    halo_begin_.push_back(static_cast<std::uint32_t>(halo_sum_.size()));
  }
}

void StiffnessOperator::load(std::size_t grain, const double* x) const {
  double row[6] = {};
  for (std::size_t k = 0; k < width_; ++k) row[components_[k]] = x[grain * width_ + k];
  for (int k = 0; k < 3; ++k) {
    rows_[grain].u[k] = scale_[grain] * row[k];
    rows_[grain].turn[k] = turn_scale_[grain] * row[k + 3];
  }
}

void StiffnessOperator::sum_chunk(std::size_t chunk) const {
  const Chunk &begin = chunks_[chunk], &end = chunks_[chunk + 1];
  std::fill(sums_.begin() + static_cast<std::ptrdiff_t>(begin.first_sum),
            sums_.begin() + static_cast<std::ptrdiff_t>(end.first_sum), Row{});
  for (std::size_t c = begin.first_link; c < end.first_link; ++c) {
    const Link& s = links_[c];
    const Row &xi = rows_[s.i], &xj = rows_[s.j];
    const Vec3 turn{s.arm_i * xi.turn[0] + s.arm_j * xj.turn[0], s.arm_i * xi.turn[1] + s.arm_j * xj.turn[1],
                    s.arm_i * xi.turn[2] + s.arm_j * xj.turn[2]};
    const Vec3 relative = Vec3{xj.u[0] - xi.u[0], xj.u[1] - xi.u[1], xj.u[2] - xi.u[2]} + cross(s.n, turn);
    const Vec3 force = s.tangential * relative + ((s.normal - s.tangential) * dot(s.n, relative)) * s.n;
    const Vec3 moment = cross(force, s.n);  // of unit arm, on either grain
    Row& i = sums_[s.to_i];
    for (int k = 0; k < 3; ++k) {
      i.u[k] -= force[k];
      i.turn[k] += s.arm_i * moment[k];
    }
    Row& j = sums_[s.to_j];
    for (int k = 0; k < 3; ++k) {
      j.u[k] += force[k];
      j.turn[k] += s.arm_j * moment[k];
    }
  }
}

void StiffnessOperator::store(std::size_t grain, double* y) const {
  double row[6] = {};
  for (auto h = halo_begin_[grain]; h < halo_begin_[grain + 1]; ++h)
    for (int k = 0; k < 3; ++k) {
      row[k] += sums_[halo_sum_[h]].u[k];
      row[k + 3] += sums_[halo_sum_[h]].turn[k];
    }
  for (int k = 0; k < 3; ++k) {
    row[k] *= scale_[grain];
    row[k + 3] *= turn_scale_[grain];
  }
  for (std::size_t k = 0; k < width_; ++k) y[grain * width_ + k] = row[components_[k]];
}

void StiffnessOperator::apply(std::span<const double> x, std::span<double> y) const {
  assert(x.size() == rows() && y.size() == rows());
  const auto grains = static_cast<std::ptrdiff_t>(grains_);
  const auto chunks = static_cast<std::ptrdiff_t>(chunks_.size()) - 1;
#pragma omp parallel if (chunks > 1)
  {
#pragma omp for schedule(static)
    for (std::ptrdiff_t g = 0; g < grains; ++g) load(static_cast<std::size_t>(g), x.data());
#pragma omp for schedule(static)
    for (std::ptrdiff_t c = 0; c < chunks; ++c) sum_chunk(static_cast<std::size_t>(c));
#pragma omp for schedule(static)
    for (std::ptrdiff_t g = 0; g < grains; ++g) store(static_cast<std::size_t>(g), y.data());
  }
}

}  // namespace eg
