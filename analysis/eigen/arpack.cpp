#include "eigen/arpack.hpp"

#include <arpack/arpack.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/error.hpp"

namespace eg {

struct ArpackIteration::Work {
  a_int n, basis, ido = 0, info = 1;  // info = 1: residual holds the start vector
  double tolerance;
  std::array<a_int, 11> iparam{};
  std::array<a_int, 14> ipntr{};
  std::vector<double> residual, vectors, workd, workl;

  a_int workl_size() const { return basis * (basis + 8); }
  double* address(int pointer) { return workd.data() + ipntr[static_cast<std::size_t>(pointer)] - 1; }
};

ArpackIteration::ArpackIteration(std::size_t rows, const ArpackOptions& options) : work_(std::make_unique<Work>()) {
  Work& w = *work_;
  w.n = static_cast<a_int>(rows);
  w.basis = std::min(w.n, static_cast<a_int>(options.basis));
  w.tolerance = options.tolerance;
  w.iparam[0] = 1;  // exact shifts
  w.iparam[2] = options.max_restarts;
  w.iparam[3] = 1;
  w.iparam[6] = 1;  // A x = λ x
  w.residual = random_unit_vector(rows, options.seed);
  w.vectors.resize(rows * static_cast<std::size_t>(w.basis));
  w.workd.resize(3 * rows);
  w.workl.resize(static_cast<std::size_t>(w.workl_size()));
}

ArpackIteration::~ArpackIteration() = default;
ArpackIteration::ArpackIteration(ArpackIteration&&) noexcept = default;
ArpackIteration& ArpackIteration::operator=(ArpackIteration&&) noexcept = default;

bool ArpackIteration::next() {
  Work& w = *work_;
  dsaupd_c(&w.ido, "I", w.n, "LA", 1, w.tolerance, w.residual.data(), w.basis, w.vectors.data(), w.n, w.iparam.data(),
           w.ipntr.data(), w.workd.data(), w.workl.data(), w.workl_size(), &w.info);
  if (w.info != 0)
    throw RunError(fmt::format("ARPACK dsaupd stopped with info = {} after {} restarts", w.info, w.iparam[2]));
  return w.ido == 1 || w.ido == -1;
}

std::span<const double> ArpackIteration::input() const {
  return {work_->address(0), static_cast<std::size_t>(work_->n)};
}

std::span<double> ArpackIteration::output() { return {work_->address(1), static_cast<std::size_t>(work_->n)}; }

std::vector<double> ArpackIteration::take() {
  Work& w = *work_;
  std::vector<a_int> select(static_cast<std::size_t>(w.basis), 0);
  std::vector<double> vector(static_cast<std::size_t>(w.n));
  double value = 0;
  dseupd_c(1, "A", select.data(), &value, vector.data(), w.n, 0.0, "I", w.n, "LA", 1, w.tolerance, w.residual.data(),
           w.basis, w.vectors.data(), w.n, w.iparam.data(), w.ipntr.data(), w.workd.data(), w.workl.data(),
           w.workl_size(), &w.info);
  if (w.info != 0) throw RunError(fmt::format("ARPACK dseupd stopped with info = {}", w.info));
  return vector;
}

}  // namespace eg
