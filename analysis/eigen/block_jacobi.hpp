#pragma once
// Block-Jacobi preconditioner: the inverse of the diagonal blocks of a symmetric positive semidefinite matrix.
#include <cstddef>
#include <span>
#include <vector>

namespace eg {

class BlockJacobi {
 public:
  /// `blocks`: the diagonal blocks one after the other, `width` × `width` each (2, 3 or 6), symmetric. A block may be
  /// singular or zero: it is inverted with its diagonal raised by 1e-8, rows of zeros give 1.
  BlockJacobi(std::vector<double> blocks, int width);

  std::size_t rows() const;
  int width() const { return width_; }
  /// The inverse of block b, symmetric, width² numbers.
  std::span<const double> inverse(std::size_t b) const {
    const auto size = static_cast<std::size_t>(width_) * static_cast<std::size_t>(width_);
    return std::span(inverse_).subspan(b * size, size);
  }
  /// z = D⁻¹ r
  void apply(std::span<const double> r, std::span<double> z) const;

 private:
  std::vector<double> inverse_;
  int width_;
};

}  // namespace eg
