#include "timestep/upper_end.hpp"

#include <algorithm>
#include <cmath>

#include "timestep/collatz.hpp"
#include "timestep/incomplete_cholesky.hpp"
#include "timestep/patch.hpp"
#include "timestep/splitting.hpp"

namespace eg {
namespace {

constexpr double drop = 1e-3, small_drop = 1e-4;  // fill given up by the incomplete factorisation
constexpr std::size_t small = 400;                // grains that are always worth a factorisation
constexpr double hot = 0.97;                      // of σ: grains whose contacts get matrices
constexpr int sweeps = 7;                         // of the matrices at each exponent
constexpr int first_squaring = 5, last_squaring = 7;

class Search {
 public:
  Search(const Sides& sides, const ScalarWeights& weights, const UpperEndOptions& options)
      : sides_(sides), options_(options), ranges_(weights.ranges), contacts_(sides, {weights.t, {}, {}}) {}

  UpperEnd run() {
    if (split() || factorise(options_.width, {2}, 0.5, drop, 2 * small) ||
        factorise(options_.width, {2}, 0.5, small_drop) || factorise(options_.loose, {2}, 0.25, drop))
      return end_;
    improve();
    if (!(end_.value <= goal(options_.loose))) take(collatz_bound(sides_.network()).value, "block Collatz-Wielandt");
    return end_;
  }

 private:
  double goal(double width) const { return options_.lower * (1 + width); }

  void take(double bound, const char* method) {
    if (bound < end_.value) end_ = {bound, method};
  }

  /// The bound of contact splitting with the weights at hand: is it close enough?
  bool split() {
    const bool scalars = contacts_.weights().matrix_spring.empty();
    take(contacts_.bound(ranges_).value, scalars ? "contact splitting" : "contact splitting with matrices");
    return end_.value <= goal(options_.width);
  }

  /// Incomplete Cholesky of what splitting leaves open at this width, if that is at most this share of the grains or
  /// `most` of them.
  bool factorise(double width, const Shells& shells, double share, double fill, std::size_t most = small) {
    const double sigma = goal(width);
    if (end_.value <= sigma) return true;
    const auto patch = stiff_patch(contacts_, ranges_, sigma, shells);
    if (static_cast<double>(patch.size()) >
        std::max(static_cast<double>(most), share * static_cast<double>(sides_.size())))
      return false;
    if (!factorise_below(contacts_, patch, sigma, fill).below) return false;
    take(sigma, "incomplete Cholesky of the stiff patches");
    return true;
  }

  /// Matrices for the contacts that scalars leave open, until splitting or a factorisation of the rest succeeds, with
  /// all neighbours of the open grains if these are few, else with the stiff ones.
  void improve() {
    for (int squarings = first_squaring; squarings <= last_squaring; ++squarings) {
      const double maximum = *std::max_element(ranges_.low.begin(), ranges_.low.end());
      contacts_.make_matrices(ranges_.low, hot * std::min(1.0, goal(options_.loose) / maximum));
      for (int k = 0; k < sweeps; ++k) contacts_.sweep(squarings);
      contacts_.update(ranges_);
      if (squarings < last_squaring)
        for (const double least : {0.0, 0.97})
          if (factorise(options_.loose, {1, least}, 0.15, small_drop, small / 2)) return;
    }
    if (factorise(options_.loose, {1, 0.98}, 0.3, 2 * small_drop, 2 * small)) return;
    for (const double least : {0.97, 0.0})
      if (factorise(options_.loose, {1, least}, 0.3, small_drop, 2 * small)) return;
    split();
  }

  const Sides& sides_;
  UpperEndOptions options_;
  BlockRanges ranges_;
  WeightedContacts contacts_;
  UpperEnd end_{INFINITY, {}};
};

}  // namespace

UpperEnd find_upper_end(const Sides& sides, const ScalarWeights& weights, const UpperEndOptions& options) {
  return Search(sides, weights, options).run();
}

}  // namespace eg
