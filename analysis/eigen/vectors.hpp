#pragma once
// Vector sums that do not depend on the number of threads, with an error that grows with the number of pieces and not
// with the length: fixed pieces are summed alone, then one after the other.
#include <cstdint>
#include <span>
#include <vector>

namespace eg {

double dot(std::span<const double> x, std::span<const double> y);
double norm(std::span<const double> x);
/// y += a x
void add_scaled(std::span<double> y, double a, std::span<const double> x);
/// y = a y + x
void scale_and_add(std::span<double> y, double a, std::span<const double> x);
void scale(std::span<double> x, double a);
/// Independent normal deviates, scaled to length 1.
std::vector<double> random_unit_vector(std::size_t size, std::uint64_t seed);

}  // namespace eg
