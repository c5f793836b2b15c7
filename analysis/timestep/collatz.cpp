#include "timestep/collatz.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace eg {
namespace {

/// The matrix N: a diagonal, and one number a split contact.
struct BlockNorms {
  const Sides& sides;
  std::vector<double> diagonal, coupling;

  explicit BlockNorms(const Sides& s);
  double row(std::size_t grain, const std::vector<double>& y) const;
};

/// ‖A_iᵀA_j‖₂. In contact axes A Aᵀ = diag(kn/m, kt (1/m + a²/I), same), so the norm is a maximum of products.
double coupling_norm(const Network& network, const Spring& s) {
  if (s.couple)
    return std::max(s.normal, s.tangential) * std::sqrt(network.inverse_inertia[s.i] * network.inverse_inertia[s.j]);
  const auto turning = [&](Index grain, double arm) {
    return network.inverse_mass[grain] + (network.rotation ? arm * arm * network.inverse_inertia[grain] : 0.0);
  };
  const double normal = s.normal * std::sqrt(network.inverse_mass[s.i] * network.inverse_mass[s.j]);
  return std::max(normal, s.tangential * std::sqrt(turning(s.i, s.arm_i) * turning(s.j, s.arm_j)));
}

BlockNorms::BlockNorms(const Sides& s) : sides(s), diagonal(s.size(), 0.0), coupling(s.network().springs.size(), 0.0) {
  const auto& springs = s.network().springs;
  for (std::size_t g = 0; g < s.size(); ++g) {
    const std::size_t terms = s.of(g).size();
    if (terms == 0) continue;
    const Block block = s.block(g, [&](const Side& side) { return contact_stiffness(springs[side.spring]); });
    diagonal[g] = block_upper_bound(block, terms);
  }
  for (std::size_t c = 0; c < springs.size(); ++c)
    if (s.is_split(c)) coupling[c] = coupling_norm(s.network(), springs[c]);
}

double BlockNorms::row(std::size_t grain, const std::vector<double>& y) const {
  double sum = diagonal[grain] * y[grain];
  for (const Side& side : sides.of(grain)) {
    if (side.role == Side::Role::alone) continue;
    const Spring& s = sides.network().springs[side.spring];
    sum += coupling[side.spring] * y[side.role == Side::Role::first ? s.j : s.i];
  }
  return sum;
}

}  // namespace

CollatzBound collatz_bound(const Network& network, int sweeps) {
  const Sides sides(network);
  const BlockNorms norms(sides);
  std::vector<double> y(sides.size(), 1.0), next(sides.size(), 1.0);
  CollatzBound best;
  best.value = INFINITY;
  for (int sweep = 0; sweep <= sweeps; ++sweep) {
    CollatzBound now;
    double largest = 0;
    for (std::size_t g = 0; g < sides.size(); ++g) {
      const std::size_t terms = sides.of(g).size();
      if (terms == 0) continue;
      const double product = norms.row(g, y);
      const double margin = (static_cast<double>(terms) + 16) * std::numeric_limits<double>::epsilon();
      const double ratio = product / y[g] * (1 + 2 * margin);
      if (ratio > now.value) now.value = ratio, now.grain = static_cast<Index>(g);
      // Averaging with y damps the sign-changing modes of a lattice and keeps y positive.
      next[g] = product + 0.5 * norms.diagonal[g] * y[g];
      largest = std::max(largest, next[g]);
    }
    if (now.value < best.value) best = now;
    best.sweeps = sweep;
    if (largest == 0) break;
    for (std::size_t g = 0; g < sides.size(); ++g) y[g] = std::max(next[g] / largest, 1e-200);
  }
  return best;
}

}  // namespace eg
