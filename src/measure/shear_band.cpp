#include "measure/shear_band.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace eg {

namespace {

constexpr double pi = std::numbers::pi;

/// Direction (2D: one angle; 3D: two), place and thickness of a band; lengths over the size of the point cloud.
using Guess = std::array<double, 4>;

/// A sample of the field with its best homogeneous part taken away.
class Residue {
 public:
  Residue(std::span<const Vec3> points, std::span<const Vec3> displacements, int dimension, std::size_t stride)
      : dimension_(dimension) {
    for (std::size_t i = 0; i < points.size(); i += stride)
      points_.push_back(points[i]), u_.push_back(displacements[i]);
    for (const auto& x : points_) centre_ += (1 / static_cast<double>(points_.size())) * x;
    for (const auto& x : points_) size_ += dot(x - centre_, x - centre_) / static_cast<double>(points_.size());
    size_ = std::sqrt(size_);
    for (auto& x : points_) x = (1 / size_) * (x - centre_);
    make_basis();
    for (const auto& e : basis_) {
      Vec3 part;
      for (std::size_t i = 0; i < u_.size(); ++i) part += e[i] * u_[i];
      for (std::size_t i = 0; i < u_.size(); ++i) u_[i] -= e[i] * part;
    }
    for (const auto& u : u_) total_ += dot(u, u);
  }

  Vec3 normal(const Guess& g) const {
    if (dimension_ == 2) return {std::cos(g[0]), std::sin(g[0]), 0};
    return {std::sin(g[1]) * std::cos(g[0]), std::sin(g[1]) * std::sin(g[0]), std::cos(g[1])};
  }

  /// Share of the residue that a band explains, and its jump [m]; nothing for a band beyond the points.
  double explained(const Guess& g, Vec3* jump = nullptr) {
    const Vec3 n = normal(g);
    const double thickness = std::max(g[3], 1e-6);
    double low = INFINITY, high = -INFINITY;
    ramp_.resize(points_.size());
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const double s = dot(n, points_[i]);
      low = std::min(low, s), high = std::max(high, s);
      ramp_[i] = std::clamp((s - g[2]) / thickness, -0.5, 0.5);
    }
    if (thickness > 0.5 * (high - low) || g[2] - thickness / 2 < low || g[2] + thickness / 2 > high) return 0;
    for (const auto& e : basis_) {
      double part = 0;
      for (std::size_t i = 0; i < ramp_.size(); ++i) part += e[i] * ramp_[i];
      for (std::size_t i = 0; i < ramp_.size(); ++i) ramp_[i] -= part * e[i];
    }
    double size = 0;
    Vec3 product;
    for (std::size_t i = 0; i < ramp_.size(); ++i) size += ramp_[i] * ramp_[i], product += ramp_[i] * u_[i];
    if (!(size > 1e-12 * static_cast<double>(ramp_.size())) || !(total_ > 0)) return 0;
    if (jump) *jump = (1 / size) * product;
    return dot(product, product) / (size * total_);
  }

  double size() const { return size_; }
  const Vec3& centre() const { return centre_; }

 private:
  /// Orthonormal functions that span 1, x, y (, z) over the points (Gram and Schmidt, twice).
  void make_basis() {
    for (int k = 0; k <= dimension_; ++k) {
      std::vector<double> e;
      for (const auto& x : points_) e.push_back(k == 0 ? 1.0 : x[k - 1]);
      for (int pass = 0; pass < 2; ++pass) {
        for (const auto& b : basis_) {
          double part = 0;
          for (std::size_t i = 0; i < e.size(); ++i) part += b[i] * e[i];
          for (std::size_t i = 0; i < e.size(); ++i) e[i] -= part * b[i];
        }
        double length = 0;
        for (const double v : e) length += v * v;
        for (double& v : e) v = length > 1e-20 ? v / std::sqrt(length) : 0;
      }
      basis_.push_back(e);
    }
  }

  int dimension_;
  std::vector<Vec3> points_, u_;
  Vec3 centre_;
  double size_ = 0, total_ = 0;
  std::vector<std::vector<double>> basis_;
  std::vector<double> ramp_;
};

/// Directions of half a sphere (2D: half a circle), some 8° apart.
std::vector<Guess> directions(int dimension) {
  std::vector<Guess> all;
  if (dimension == 2) {
    for (int k = 0; k < 24; ++k) all.push_back({pi * k / 24, 0, 0, 0});
    return all;
  }
  constexpr int rows = 10;
  for (int row = 0; row <= rows; ++row) {
    const double height = pi / 2 * row / rows;
    const int columns = std::max(1, static_cast<int>(std::lround(4 * rows * std::sin(height))));
    for (int k = 0; k < columns; ++k) all.push_back({2 * pi * k / columns, height, 0, 0});
  }
  return all;
}

/// Steps along each number of the guess in turn, halved when none helps.
Guess refined(Residue& residue, Guess guess, int dimension, double angle_step, double length_step, double smallest) {
  Guess step{angle_step, dimension == 3 ? angle_step : 0, length_step, length_step};
  double best = residue.explained(guess);
  while (step[0] > smallest) {
    bool moved = false;
    for (std::size_t k = 0; k < guess.size(); ++k)
      for (const double sign : {-1., 1.}) {
        if (step[k] == 0) continue;
        Guess other = guess;
        other[k] += sign * step[k];
        if (k == 3 && other[k] <= 0) other[k] = guess[k] / 2;
        if (const double value = residue.explained(other); value > best) best = value, guess = other, moved = true;
      }
    if (!moved)
      for (double& s : step) s /= 2;
  }
  return guess;
}

Guess scanned(Residue& residue, int dimension) {
  std::vector<std::pair<double, Guess>> found;
  for (Guess g : directions(dimension)) {
    std::pair<double, Guess> best{-1, g};
    for (int place = -9; place <= 9; ++place)
      for (const double thickness : {0.1, 0.3, 0.8}) {
        g[2] = 0.15 * place, g[3] = thickness;
        if (const double value = residue.explained(g); value > best.first) best = {value, g};
      }
    found.push_back(best);
  }
  std::ranges::sort(found, std::ranges::greater{}, &std::pair<double, Guess>::first);
  found.resize(std::min<std::size_t>(found.size(), 5));  // neighbours of a ridge may lead to better ends
  for (auto& [value, g] : found) g = refined(residue, g, dimension, 0.07, 0.1, 0.005), value = residue.explained(g);
  return std::ranges::max_element(found, {}, &std::pair<double, Guess>::first)->second;
}

}  // namespace

std::optional<ShearBand> find_shear_band(std::span<const Vec3> points, std::span<const Vec3> displacements,
                                         int dimension) {
  if (points.size() < 20) return std::nullopt;
  Residue coarse(points, displacements, dimension, (points.size() + 399) / 400);
  Residue all(points, displacements, dimension, 1);
  Guess guess = scanned(coarse, dimension);
  const double offset = dot(coarse.normal(guess), coarse.centre() - all.centre());
  guess[2] = (guess[2] * coarse.size() + offset) / all.size();  // from one sample's measure to the other's
  guess[3] *= coarse.size() / all.size();
  guess = refined(all, guess, dimension, 0.01, 0.01, 1e-5);
  ShearBand band;
  band.explained = all.explained(guess, &band.jump);
  band.normal = all.normal(guess);
  const double lead = std::abs(band.normal.x) > 1e-9   ? band.normal.x
                      : std::abs(band.normal.y) > 1e-9 ? band.normal.y
                                                       : band.normal.z;
  if (lead < 0) band.normal = -band.normal, guess[2] = -guess[2], band.jump = -band.jump;
  band.thickness = all.size() * guess[3];
  band.position = all.size() * guess[2] + dot(band.normal, all.centre());
  return band;
}

}  // namespace eg
