#include "search/travel.hpp"

#include <algorithm>
#include <cmath>

namespace eg {
namespace {

constexpr std::size_t least_size = 128, most_blocks = 1024;

Double4 lower(Double4 a, Double4 b) { return a < b ? a : b; }
Double4 upper(Double4 a, Double4 b) { return a > b ? a : b; }
double square(Double4 v) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; }
Double4 vector(const Vec3& v) { return Double4{v.x, v.y, v.z, 0}; }

/// Of a block, in fractions of the cell along its axes.
struct Extent {
  Double4 low, high;
};

std::vector<Extent> extents(const State& state, std::size_t blocks, std::size_t size) {
  const auto& reference = state.list.reference;
  const Mat3 inv = inverse(state.list.reference_cell);
  std::vector<Extent> out(blocks);
#pragma omp parallel for schedule(static) if (reference.size() >= Contacts::worth_threads * Contacts::chunk)
  for (std::size_t b = 0; b < blocks; ++b) {
    Extent e{Double4{} + INFINITY, Double4{} - INFINITY};
    for (std::size_t i = b * size; i < std::min(reference.size(), (b + 1) * size); ++i) {
      const Double4 s = vector(inv * reference[i]);
      e.low = lower(e.low, s), e.high = upper(e.high, s);
    }
    out[b] = e;
  }
  return out;
}

/// Whether two extents come nearer than `reach` along every axis, in some image.
bool are_near(const Extent& a, const Extent& b, const Double4& reach, const std::array<bool, 3>& periodic) {
  for (int k = 0; k < 3; ++k) {
    const double after = b.low[k] - a.high[k], before = a.low[k] - b.high[k];  // gaps; < 0 when they overlap
    double gap = std::max(after, before);
    if (periodic[static_cast<std::size_t>(k)])
      gap = std::min({gap, std::max(after - 1, before + 1), std::max(after + 1, before - 1)});
    if (gap > reach[k]) return false;
  }
  return true;
}

}  // namespace

void Blocks::reset(const State& state) {
  const std::size_t n = state.grains.size();
  for (size_ = least_size; (n + size_ - 1) / size_ > most_blocks;) size_ *= 2;
  const std::size_t blocks = (n + size_ - 1) / size_;
  low_.assign(blocks, Double4{}), high_.assign(blocks, Double4{});
  slack_ = 0;

  const auto extent = extents(state, blocks, size_);
  Cell cell = state.cell;
  cell.h = state.list.reference_cell;
  Double4 reach{};
  for (int k = 0; k < 3; ++k) reach[k] = 4 * state.list.longest / cell.width(k);
  begin_.assign(1, 0), near_.clear();
  for (std::size_t a = 0; a < blocks; ++a) {
    for (std::size_t b = a; b < blocks; ++b)
      if (are_near(extent[a], extent[b], reach, cell.periodic)) near_.push_back(static_cast<std::uint32_t>(b));
    begin_.push_back(near_.size());
  }
}

void Blocks::measure(const State& state) {
  const auto& x = state.grains.position;
  const Mat3 f = state.cell.h * inverse(state.list.reference_cell);
#pragma omp parallel for schedule(static) if (x.size() >= Contacts::worth_threads * Contacts::chunk)
  for (std::size_t b = 0; b < count(); ++b) {
    Double4 low = Double4{} + INFINITY, high = Double4{} - INFINITY;
    for (std::size_t i = begin(b); i < end(b, x.size()); ++i) {
      const Double4 u = vector(x[i].vec() - f * state.list.reference[i]);
      low = lower(low, u), high = upper(high, u);
    }
    low_[b] = low, high_[b] = high;
  }
  slack_ = 0;
}

double Blocks::most() const {
  double most = 0;
  for (std::size_t b = 0; b < count(); ++b) most = std::max(most, square(upper(-low_[b], high_[b])));
  return std::sqrt(most);
}

Travel Blocks::coarse() const {
  Double4 low{}, high{};
  for (std::size_t b = 0; b < count(); ++b) low = lower(low, low_[b]), high = upper(high, high_[b]);
  return {std::sqrt(square(upper(-low, high))) + slack_, std::sqrt(square(high - low)) + 2 * slack_};
}

Travel Blocks::travel() const {
  double most = 0;
  for (std::size_t a = 0; a < count(); ++a)
    for (std::size_t k = begin_[a]; k < begin_[a + 1]; ++k) {
      const std::size_t b = near_[k];
      most = std::max(most, square(upper(high_[a] - low_[b], high_[b] - low_[a])));
    }
  return {this->most() + slack_, std::sqrt(most) + 2 * slack_};
}

}  // namespace eg
