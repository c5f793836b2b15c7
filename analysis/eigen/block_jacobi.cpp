#include "eigen/block_jacobi.hpp"

#include <Eigen/Cholesky>
#include <cassert>

namespace eg {
namespace {

template <int width>
using Block = Eigen::Matrix<double, width, width>;
template <int width>
using Row = Eigen::Matrix<double, width, 1>;

template <int width>
void invert(std::vector<double>& blocks) {
  const auto count = static_cast<std::ptrdiff_t>(blocks.size() / (width * width));
#pragma omp parallel for schedule(static) if (count > 4000)
  for (std::ptrdiff_t b = 0; b < count; ++b) {
    Eigen::Map<Block<width>> block(blocks.data() + b * width * width);
    for (int k = 0; k < width; ++k) block(k, k) = block(k, k) > 0 ? block(k, k) * (1 + 1e-8) : 1.0;
    block = block.llt().solve(Block<width>::Identity()).eval();
  }
}

template <int width>
void multiply(const std::vector<double>& blocks, const double* r, double* z) {
  const auto count = static_cast<std::ptrdiff_t>(blocks.size() / (width * width));
#pragma omp parallel for schedule(static) if (count > 4000)
  for (std::ptrdiff_t b = 0; b < count; ++b) {
    const Eigen::Map<const Block<width>> block(blocks.data() + b * width * width);
    const Eigen::Map<const Row<width>> in(r + b * width);
    Eigen::Map<Row<width>> out(z + b * width);
    out.noalias() = block.lazyProduct(in);
  }
}

}  // namespace

BlockJacobi::BlockJacobi(std::vector<double> blocks, int width) : inverse_(std::move(blocks)), width_(width) {
  assert(width == 2 || width == 3 || width == 6);
  if (width == 2) invert<2>(inverse_);
  if (width == 3) invert<3>(inverse_);
  if (width == 6) invert<6>(inverse_);
}

std::size_t BlockJacobi::rows() const { return inverse_.size() / static_cast<std::size_t>(width_); }

void BlockJacobi::apply(std::span<const double> r, std::span<double> z) const {
  assert(r.size() == rows() && z.size() == rows());
  if (width_ == 2) multiply<2>(inverse_, r.data(), z.data());
  if (width_ == 3) multiply<3>(inverse_, r.data(), z.data());
  if (width_ == 6) multiply<6>(inverse_, r.data(), z.data());
}

}  // namespace eg
