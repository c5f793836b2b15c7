#include "waves/unit_cell.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace eg {
namespace {

constexpr double same = 1e-7;  // of the quantity, or of a diameter for places

/// A spring as one of its grains sees it.
struct Sight {
  Index to;
  Spring spring;  ///< turned so that i is the grain that looks
  Vec3 branch() const { return spring.n * spring.length; }
};

Spring turned(Spring s) {
  std::swap(s.i, s.j);
  std::swap(s.arm_i, s.arm_j);
  s.n = -s.n;
  return s;
}

bool close(double a, double b, double scale) { return std::abs(a - b) <= same * scale; }

bool below(const Vec3& a, const Vec3& b, double scale) {
  for (int k = 0; k < 3; ++k)
    if (!close(a[k], b[k], scale)) return a[k] < b[k];
  return false;
}

class Symmetry {
 public:
  Symmetry(const Network& network, std::span<const Vec3> position, const Mat3& edges)
      : net_(network), at_(position), edges_(edges), to_fraction_(inverse(edges)), sights_(network.size()) {
    for (const auto& s : net_.springs) {
      sights_[s.i].push_back({s.j, s});
      sights_[s.j].push_back({s.i, turned(s)});
    }
    size_ = 2 * *std::ranges::max_element(net_.radius);
    for (auto& list : sights_)
      std::ranges::stable_sort(  // a contact stays before its couple
          list, [this](const Sight& a, const Sight& b) { return below(a.branch(), b.branch(), size_); });
    order_.resize(net_.size());
    std::iota(order_.begin(), order_.end(), Index{0});
    for (const auto& x : at_) wrapped_.push_back(wrap(x));
    std::ranges::sort(order_, {}, [this](Index i) { return wrapped_[i].x; });
  }

  /// Whether the grains look alike: mass, size, and all their springs.
  bool alike(std::size_t i, std::size_t j) const {
    const auto relative = [](double a, double b) { return close(a, b, std::abs(a)); };
    if (!relative(net_.inverse_mass[i], net_.inverse_mass[j]) || !relative(net_.radius[i], net_.radius[j]))
      return false;
    if (net_.rotation && !relative(net_.inverse_inertia[i], net_.inverse_inertia[j])) return false;
    const auto& a = sights_[i];
    const auto& b = sights_[j];
    return std::ranges::equal(a, b, [&](const Sight& p, const Sight& q) {
      return p.spring.couple == q.spring.couple && norm(p.branch() - q.branch()) <= same * size_ &&
             relative(p.spring.normal, q.spring.normal) &&
             close(p.spring.tangential, q.spring.tangential, std::max(p.spring.normal, p.spring.tangential)) &&
             relative(p.spring.arm_i, q.spring.arm_i) && relative(p.spring.arm_j, q.spring.arm_j);
    });
  }

  /// Whether moving every grain by t gives the same packing.
  bool keeps(const Vec3& t) const {
    for (std::size_t i = 0; i < net_.size(); ++i) {
      const Index j = find(at_[i] + t);
      if (j == no_index || !alike(i, j)) return false;
    }
    return true;
  }

  /// The grain at x or one of its images; no_index when there is none.
  Index find(const Vec3& x) const {
    const Vec3 f = wrap(x);
    const double reach = same * size_ * 10 *
                         std::sqrt(to_fraction_(0, 0) * to_fraction_(0, 0) + to_fraction_(0, 1) * to_fraction_(0, 1) +
                                   to_fraction_(0, 2) * to_fraction_(0, 2));
    for (const double turn : {0.0, -1.0, 1.0}) {
      auto low = std::ranges::lower_bound(order_, f.x + turn - reach, {}, [this](Index i) { return wrapped_[i].x; });
      for (; low != order_.end() && wrapped_[*low].x <= f.x + turn + reach; ++low) {
        Vec3 gap = f - wrapped_[*low];
        for (int k = 0; k < 3; ++k) gap[k] -= std::round(gap[k]);
        if (norm(edges_ * gap) <= 10 * same * size_) return *low;
      }
    }
    return no_index;
  }

  const std::vector<Sight>& sights(std::size_t i) const { return sights_[i]; }
  double size() const { return size_; }

 private:
  Vec3 wrap(const Vec3& x) const {
    Vec3 f = to_fraction_ * x;
    for (int k = 0; k < 3; ++k) f[k] -= std::floor(f[k]);
    return f;
  }

  const Network& net_;
  std::span<const Vec3> at_;
  Mat3 edges_, to_fraction_;
  std::vector<std::vector<Sight>> sights_;
  std::vector<Vec3> wrapped_;
  std::vector<Index> order_;
  double size_ = 0;  ///< largest diameter
};

/// Volume spanned by `vectors` and, for those that are missing, unit vectors at right angles to them; over their
/// lengths.
double independence(const std::vector<Vec3>& vectors) {
  double length = 1;
  for (const auto& v : vectors) length *= norm(v);
  if (vectors.size() == 3) return std::abs(dot(cross(vectors[0], vectors[1]), vectors[2])) / length;
  if (vectors.size() == 2) return norm(cross(vectors[0], vectors[1])) / length;
  return 1;
}

/// Where the first grain may go to by a symmetry, the shortest way first; the edges of the cell among them.
std::vector<Vec3> candidates(const Symmetry& symmetry, const Network& net, std::span<const Vec3> at,
                             const Mat3& edges) {
  std::vector<Vec3> found;
  const int depth = net.dimension == 3 ? 1 : 0;
  for (std::size_t j = 0; j < net.size(); ++j) {
    if (j > 0 && !symmetry.alike(0, j)) continue;
    for (int c = -depth; c <= depth; ++c)
      for (int b = -1; b <= 1; ++b)
        for (int a = -1; a <= 1; ++a) {
          const Vec3 t = at[j] - at[0] + edges * Vec3{double(a), double(b), double(c)};
          if (norm(t) > 0.1 * symmetry.size()) found.push_back(t);
        }
  }
  std::ranges::stable_sort(found, [&](const Vec3& a, const Vec3& b) {
    return close(norm(a), norm(b), norm(a)) ? below(b, a, symmetry.size()) : norm(a) < norm(b);
  });
  return found;
}

/// The shortest independent translations; in two and three dimensions they generate all others (Minkowski).
Mat3 shortest_translations(const Symmetry& symmetry, const Network& net, std::span<const Vec3> at, const Mat3& edges) {
  std::vector<Vec3> basis;
  const auto wanted = static_cast<std::size_t>(net.dimension);
  for (const auto& t : candidates(symmetry, net, at, edges)) {
    if (basis.size() == wanted) break;
    basis.push_back(t);
    if (independence(basis) < 1e-3 || !symmetry.keeps(t)) basis.pop_back();
  }
  if (basis.size() < wanted) return edges;
  if (wanted == 2) basis.push_back({0, 0, 1});
  Mat3 columns;
  for (int k = 0; k < 3; ++k)
    for (int r = 0; r < 3; ++r) columns(r, k) = basis[static_cast<std::size_t>(k)][r];
  return columns;
}

/// One grain of each kind, and the kind of every grain.
struct Kinds {
  std::vector<Index> first, of;
};

Kinds kinds_of(const Symmetry& symmetry, std::span<const Vec3> at, const Mat3& cell) {
  Kinds kinds;
  kinds.of.assign(at.size(), no_index);
  for (std::size_t i = 0; i < at.size(); ++i) {
    if (kinds.of[i] != no_index) continue;
    const auto kind = static_cast<Index>(kinds.first.size());
    kinds.first.push_back(static_cast<Index>(i));
    kinds.of[i] = kind;
    std::vector<std::size_t> open{i};  // all that translations reach from it
    while (!open.empty()) {
      const std::size_t from = open.back();
      open.pop_back();
      for (int k = 0; k < 3; ++k) {
        const Index j = symmetry.find(at[from] + Vec3{cell(0, k), cell(1, k), cell(2, k)});
        if (j == no_index || kinds.of[j] != no_index) continue;
        kinds.of[j] = kind;
        open.push_back(j);
      }
    }
  }
  return kinds;
}

}  // namespace

UnitCell find_unit_cell(const Network& net, std::span<const Vec3> at, const Mat3& edges) {
  const UnitCell whole{net, {at.begin(), at.end()}, edges, 1};
  if (net.size() == 0) return whole;
  const Symmetry symmetry(net, at, edges);
  const Mat3 cell = shortest_translations(symmetry, net, at, edges);
  const auto copies = static_cast<std::size_t>(std::lround(std::abs(determinant(edges) / determinant(cell))));
  if (copies <= 1 || net.size() % copies != 0) return whole;
  const Kinds kinds = kinds_of(symmetry, at, cell);
  if (kinds.first.size() * copies != net.size()) return whole;

  UnitCell unit;
  unit.edges = cell, unit.copies = copies;
  unit.network.dimension = net.dimension, unit.network.rotation = net.rotation;
  for (const Index i : kinds.first) {
    unit.position.push_back(at[i]);
    unit.network.inverse_mass.push_back(net.inverse_mass[i]);
    if (net.rotation) unit.network.inverse_inertia.push_back(net.inverse_inertia[i]);
    unit.network.radius.push_back(net.radius[i]);
    unit.network.id.push_back(net.id[i]);
    for (const Sight& sight : symmetry.sights(i)) {  // every spring from one of its two sides
      const Index from = kinds.of[i], to = kinds.of[sight.to];
      if (from > to || (from == to && below(sight.branch(), {}, symmetry.size()))) continue;
      Spring spring = sight.spring;
      spring.i = from, spring.j = to;
      unit.network.springs.push_back(spring);
    }
  }
  return unit;
}

}  // namespace eg
