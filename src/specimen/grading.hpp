#pragma once
// Sizes of grains drawn from a grading, and the grading curve of grains at hand.
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "base/random.hpp"
#include "state/grading_preset.hpp"
#include "state/scene.hpp"

namespace eg {

/// `count` radii [m] in random order. One radius is drawn from each of `count` equal slices of the distribution by
/// number, so even a small sample keeps to its grading.
///
/// A table is by mass: within one sieve interval mass is taken uniform in the diameter d, so grains by number go as
/// d⁻³ (3D) or d⁻² (2D) there. The table must run from passing 0 to 1 (Grading, state/scene.hpp).
std::vector<double> draw_radii(const Grading&, int dimension, std::size_t count, Random&);

/// How many grains of a gap grading hold `coarse` coarse ones, to the nearest.
std::size_t count_with_coarse(const Grading&, int dimension, std::size_t coarse);

/// Fraction of the mass of grains with diameter ≤ each of `diameters` [m], for grains of one density.
std::vector<double> passing_by_mass(std::span<const double> radii, int dimension, std::span<const double> diameters);

}  // namespace eg
