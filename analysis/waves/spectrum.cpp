#include "waves/spectrum.hpp"

#include <fftw3.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace eg {
namespace {

constexpr double pi = std::numbers::pi;
using Complex = std::complex<double>;

std::size_t power_of_two(std::size_t least) {
  std::size_t n = 1;
  while (n < least) n *= 2;
  return n;
}

/// Forward transform of complex data in place.
void transform(std::vector<Complex>& data) {
  auto* raw = reinterpret_cast<fftw_complex*>(data.data());
  fftw_plan plan = fftw_plan_dft_1d(static_cast<int>(data.size()), raw, raw, FFTW_FORWARD, FFTW_ESTIMATE);
  fftw_execute(plan);
  fftw_destroy_plan(plan);
}

double fade(std::size_t k, std::size_t n) {
  const double left = static_cast<double>(n - 1 - k) / (0.1 * static_cast<double>(n));
  return left >= 1 ? 1 : std::pow(std::sin(pi / 2 * left), 2);
}

}  // namespace

Complex Spectrum::at(double f) const {
  const double place = std::clamp(f / step, 0.0, static_cast<double>(value.size()) - 1.001);
  const auto k = static_cast<std::size_t>(place);
  const double t = place - static_cast<double>(k);
  return (1 - t) * value[k] + t * value[k + 1];
}

Spectrum spectrum(std::span<const double> u, double interval, int pad) {
  std::vector<Complex> data(power_of_two(u.size() * static_cast<std::size_t>(pad)));
  for (std::size_t k = 0; k < u.size(); ++k) data[k] = u[k] * fade(k, u.size()) * interval;
  transform(data);
  Spectrum s{1 / (interval * static_cast<double>(data.size())), {}};
  s.value.assign(data.begin(), data.begin() + static_cast<std::ptrdiff_t>(data.size() / 2 + 1));
  return s;
}

WaveMap wave_map(const std::vector<std::span<const double>>& traces, double interval, double spacing, double highest) {
  std::vector<Spectrum> spectra;
  for (const auto& u : traces) spectra.push_back(spectrum(u, interval, 1));
  const std::size_t n = traces.size(), padded = power_of_two(8 * n);
  WaveMap map;
  map.f_step = spectra[0].step, map.k_step = 2 * pi / (spacing * static_cast<double>(padded));
  map.columns = padded / 2 + 1;
  map.rows = std::min(spectra[0].value.size(), static_cast<std::size_t>(highest / map.f_step) + 1);
  map.value.resize(map.rows * map.columns);
  std::vector<double> most(map.rows, 0.0);
  for (std::size_t row = 0; row < map.rows; ++row) {
    std::vector<Complex> along(padded);
    for (std::size_t j = 0; j < n; ++j) {
      const double window = std::pow(std::sin(pi * (static_cast<double>(j) + 0.5) / static_cast<double>(n)), 2);
      along[j] = std::conj(spectra[j].value[row]) * window;  // conj: exp(+ikx) goes to positive wave numbers
    }
    transform(along);
    for (std::size_t c = 0; c < map.columns; ++c) {
      map.value[row * map.columns + c] = std::abs(along[c]);
      most[row] = std::max(most[row], std::abs(along[c]));
    }
  }
  const double loudest = *std::ranges::max_element(most);
  for (std::size_t row = 0; row < map.rows; ++row)
    for (std::size_t c = 0; c < map.columns; ++c)
      map.value[row * map.columns + c] *= most[row] > 1e-2 * loudest ? 1 / most[row] : 0;
  return map;
}

}  // namespace eg
