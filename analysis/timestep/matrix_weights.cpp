#include "timestep/matrix_weights.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "base/power.hpp"
#include "timestep/block_power.hpp"
#include "timestep/triangle.hpp"

namespace eg {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr std::size_t lanes = Batch::lanes;
constexpr double farthest = 0.25;  // a sweep moves ln T by no more than this,
constexpr double momentum = 0.3;   // and by this share of its last motion; more of either diverges
constexpr double widest = 2000;  // largest entry of a T or T⁻¹ in use, about: beyond it a contact is one-sided anyway

std::size_t groups_of(std::size_t count) { return (count + lanes - 1) / lanes; }

Eigen::Matrix3d full(const SymmetricSix& a) {
  Eigen::Matrix3d m;
  m << a[0], a[5], a[4], a[5], a[1], a[3], a[4], a[3], a[2];
  return m;
}

/// Numbers gathered lane by lane.
template <std::size_t size>
struct Gathered {
  alignas(64) double value[size][lanes];
  EG_INLINE Batch operator[](std::size_t k) const { return load_lanes(value[k]); }
};

/// Springs of eight matrices; lanes left over repeat the last one.
struct EightSprings {
  Vec<Batch> n;
  Batch root, excess;  ///< √kt and √kn − √kt: k^½ = √kt 1 + (√kn − √kt) nnᵀ
  Batch normal, tangential, arm_i, arm_j;

  EightSprings(const std::vector<Spring>& springs, const Index* which, std::size_t count) {
    Gathered<7> g;
    for (std::size_t l = 0; l < lanes; ++l) {
      const Spring& s = springs[which[std::min(l, count - 1)]];
      const double values[] = {s.n.x, s.n.y, s.n.z, s.normal, s.tangential, s.arm_i, s.arm_j};
      for (std::size_t k = 0; k < 7; ++k) g.value[k][l] = values[k];
    }
    n = {g[0], g[1], g[2]};
    normal = g[3], tangential = g[4], arm_i = g[5], arm_j = g[6];
    root = sqrt(tangential);
    excess = sqrt(normal) - root;
  }
  EG_INLINE Symmetric3 stiffness() const {
    const Batch e = normal - tangential;
    return Symmetric3{e * n.x * n.x, e * n.y * n.y, e * n.z * n.z, e * n.y * n.z, e * n.x * n.z, e * n.x * n.y}
        .plus_identity(tangential);
  }
};

/// D P D with B = [sign 1, a n×] on both sides: B D P D Bᵀ (3×3) for eight grains, d and e the scales of u and θ.
EG_INLINE Symmetric3 seen_from_contact(const Gathered<21>& p, const Vec<Batch>& n, Batch sign_d, Batch a_e) {
  const auto at = [&](std::size_t r, std::size_t c) { return p[Triangle::at(r, c)]; };
  const Symmetric3 uu{at(0, 0), at(1, 1), at(2, 2), at(2, 1), at(2, 0), at(1, 0)};
  // Rows of P_uθ Nᵀ and of P_θθ Nᵀ: Nᵀ on the right of a row w gives n × w.
  const auto row = [&](std::size_t r) { return cross(n, Vec<Batch>{at(r, 3), at(r, 4), at(r, 5)}); };
  const Vec<Batch> x = row(0), y = row(1), z = row(2), tx = row(3), ty = row(4), tz = row(5);
  const Vec<Batch> cx = cross(n, Vec<Batch>{tx.x, ty.x, tz.x}), cy = cross(n, Vec<Batch>{tx.y, ty.y, tz.y}),
                   cz = cross(n, Vec<Batch>{tx.z, ty.z, tz.z});
  const Batch two(2.0), mixed = sign_d * a_e;
  const Symmetric3 ut{two * x.x, two * y.y, two * z.z, y.z + z.y, x.z + z.x, x.y + y.x};
  const Symmetric3 tt{cx.x, cy.y, cz.z, cz.y, cz.x, cy.x};
  return uu * (sign_d * sign_d) + ut * mixed + tt * (a_e * a_e);
}

/// A matrix near singular carries no wish about the weak directions: they are held at a thousandth of its trace.
EG_INLINE Symmetric3 regular(const Symmetric3& a, Batch trace) {
  return (a * (Batch(1.0) / trace)).plus_identity(Batch(1e-3));
}

Batch natural_exponential(Batch x) { return binary_power(Batch(std::numbers::log2e), x); }
/// −∞ is −1e300 here.
Batch natural_logarithm(Batch x) {
  const Batch log = binary_logarithm(max(x, Batch(1e-300))) * Batch(std::numbers::ln2);
  return select(x > Batch(1e-300), log, Batch(-1e300));
}

/// T moved a share `step` of the way to the T* that A and B wish for, ln A and ln B larger by log_a and log_b than the
/// matrices given: its size on a logarithmic scale, its shape along the geodesic, which is halved twice and then so
/// short that arithmetic and harmonic means will do.
EG_INLINE Symmetric3 moved(const Symmetric3& t, const Symmetric3& a, const Symmetric3& b, Batch log_a, Batch log_b,
                           Batch step) {
  const Batch trace_a = a.trace(), trace_b = b.trace(), trace_t = t.trace(), one(1.0);
  Symmetric3 shape = geometric_mean(inverse(regular(a, trace_a)), regular(b, trace_b), 5);
  const Batch trace = shape.trace();
  shape = shape * (trace_t / trace);
  shape = geometric_mean(t, shape, 3);
  shape = geometric_mean(t, shape, 2);
  const Batch share = Batch(4.0) * step, rest = Batch(1.0) - share;
  const Symmetric3 high = t * rest + shape * share;
  const Symmetric3 low = inverse(inverse(t) * rest + inverse(shape) * share);
  const Symmetric3 turned = geometric_mean(high, low, 1);
  const Batch wish =
      Batch(0.5) * (log_b - log_a + natural_logarithm(trace_b / trace_a)) + natural_logarithm(trace / trace_t);
  const Batch far = natural_exponential(max(Batch(-2.0), min(Batch(2.0), step * wish)));
  return turned * (far * trace_t / turned.trace());
}

}  // namespace

WeightedContacts::WeightedContacts(const Sides& sides, SplittingWeights weights) : sides_(sides) {
  set_weights(std::move(weights));
}

void WeightedContacts::set_weights(SplittingWeights weights) {
  weights_ = std::move(weights);
  before_ = weights_.matrix;
  grains_.clear();
  matrix_of_.clear(), place_.clear(), pairs_.clear();
  if (weights_.matrix_spring.empty()) return;
  const auto& springs = sides_.network().springs;
  matrix_of_.assign(springs.size(), no_index);
  place_.assign(sides_.size(), no_index);
  for (std::size_t m = 0; m < weights_.matrix_spring.size(); ++m) {
    const Index c = weights_.matrix_spring[m];
    matrix_of_[c] = static_cast<Index>(m);
    for (const Index g : {springs[c].i, springs[c].j})
      if (std::exchange(place_[g], 0) == no_index) grains_.push_back(g);
  }
  std::sort(grains_.begin(), grains_.end());
  for (std::size_t k = 0; k < grains_.size(); ++k) place_[grains_[k]] = static_cast<Index>(k);
  pairs_.resize(weights_.matrix_spring.size());
  refresh();
}

Eigen::Matrix3d WeightedContacts::weighted_stiffness(const Side& side) const {
  const Eigen::Matrix3d k = contact_stiffness(sides_.network().springs[side.spring]);
  if (side.role == Side::Role::alone) return k;
  const bool first = side.role == Side::Role::first;
  if (!matrix_of_.empty() && matrix_of_[side.spring] != no_index) {
    const Pair& pair = pairs_[matrix_of_[side.spring]];
    return full(first ? pair.first : pair.second);
  }
  const double t = weights_.scalar[side.spring];
  return (1 + (first ? t : 1 / t)) * k;
}

/// Takes over T for the matrices from `first` on, with the pairs that follow from it, where `fit` says so.
void WeightedContacts::store(std::size_t first, std::size_t count, const Symmetric3& t, const Symmetric3& inverse,
                             Mask fit) {
  const EightSprings springs(sides_.network().springs, &weights_.matrix_spring[first], count);
  // The proof needs [T −1; −1 R] ≥ 0 of the numbers as rounded. With κ = ‖T‖‖R‖ and E = T R − 1, R (1 + 2√κ‖E‖) ≥ T⁻¹;
  // what follows has errors of some ε relative to norms, so some εκ relative to the matrices themselves.
  const Batch size_t_ = t.frobenius(), size_r = inverse.frobenius(), condition = size_t_ * size_r;
  const Batch error = distance_from_inverse(t, inverse) + Batch(64 * epsilon) * condition;
  const Symmetric3 r = inverse * (Batch(1.0) + Batch(2.0) * sqrt(condition) * error);
  const Batch stiffest = max(springs.normal, springs.tangential) * Batch(64 * epsilon);
  const Symmetric3 k = springs.stiffness();
  const auto side = [&](const Symmetric3& weight, Batch size) {
    return (k + sandwich(weight, springs.root, springs.excess, springs.n)).plus_identity(stiffest * size);
  };
  const Symmetric3 one = side(t, size_t_), two = side(r, size_r);
  const auto number = [](const Symmetric3& a, std::size_t l) {
    return SymmetricSix{a.xx[l], a.yy[l], a.zz[l], a.yz[l], a.xz[l], a.xy[l]};
  };
  for (std::size_t l = 0; l < count; ++l)
    if (lane(fit, l)) {
      weights_.matrix[first + l] = number(t, l);
      pairs_[first + l] = {number(one, l), number(two, l)};
    }
}

namespace {

Symmetric3 load_matrices(const std::vector<SymmetricSix>& matrix, std::size_t first, std::size_t count) {
  Gathered<6> g;
  for (std::size_t l = 0; l < lanes; ++l)
    for (std::size_t k = 0; k < 6; ++k) g.value[k][l] = matrix[first + std::min(l, count - 1)][k];
  return {g[0], g[1], g[2], g[3], g[4], g[5]};
}

/// Whether T is one to work with: false for what is not a number too.
Mask is_fit(const Symmetric3& t, const Symmetric3& inverse) {
  return is_positive(t) & (t.frobenius() < Batch(widest)) & (inverse.frobenius() < Batch(widest)) &
         (distance_from_inverse(t, inverse) < Batch(1e-8));
}

}  // namespace

/// Pairs anew from all matrices; T = 1 takes the place of one that is not fit.
void WeightedContacts::refresh() {
  for (std::size_t m = 0; m < pairs_.size(); m += lanes) {
    const std::size_t count = std::min(lanes, pairs_.size() - m);
    const Symmetric3 t = load_matrices(weights_.matrix, m, count), back = inverse(t);
    const Symmetric3 one{Batch(1.0), Batch(1.0), Batch(1.0), Batch(0.0), Batch(0.0), Batch(0.0)};
    const Mask fit = is_fit(t, back);
    store(m, count, one, one, !fit);
    store(m, count, t, back, fit);
  }
}

void WeightedContacts::make_matrices(const std::vector<double>& lambda, double hot) {
  const double threshold = hot * *std::max_element(lambda.begin(), lambda.end());
  SplittingWeights next{weights_.scalar, {}, {}};
  const auto& springs = sides_.network().springs;
  for (std::size_t c = 0; c < springs.size(); ++c) {
    const Index m = matrix_of_.empty() ? no_index : matrix_of_[c];
    if (m == no_index && !(sides_.is_split(c) && std::max(lambda[springs[c].i], lambda[springs[c].j]) >= threshold))
      continue;
    const double t = std::clamp(weights_.scalar[c], 2 / widest, widest / 2);
    next.matrix_spring.push_back(static_cast<Index>(c));
    next.matrix.push_back(m != no_index ? weights_.matrix[m] : SymmetricSix{t, t, t, 0, 0, 0});
  }
  set_weights(std::move(next));
}

/// S_i.
WeightedContacts::Lower WeightedContacts::lower_triangle(Index grain) const {
  double uu[6] = {}, ut[3][3] = {}, tt[6] = {};
  const auto& springs = sides_.network().springs;
  for (const Side& side : sides_.of(grain)) {
    const Spring& s = springs[side.spring];
    SymmetricSix w;
    if (const Index m = matrix_of_[side.spring]; m != no_index) {
      w = side.role == Side::Role::first ? pairs_[m].first : pairs_[m].second;
    } else {
      const double t = weights_.scalar[side.spring];
      const double f = side.role == Side::Role::alone ? 1 : 1 + (side.role == Side::Role::first ? t : 1 / t);
      const double kt = f * s.tangential, e = f * s.normal - kt;
      w = {e * s.n.x * s.n.x + kt, e * s.n.y * s.n.y + kt, e * s.n.z * s.n.z + kt,
           e * s.n.y * s.n.z,      e * s.n.x * s.n.z,      e * s.n.x * s.n.y};
    }
    const auto [sign, arm] = Sides::lever_of(s, side);
    const Vec3 n = arm * s.n;
    const Vec3 z[3] = {cross({w[0], w[5], w[4]}, n), cross({w[5], w[1], w[3]}, n), cross({w[4], w[3], w[2]}, n)};
    for (int k = 0; k < 6; ++k) uu[k] += std::abs(sign) * w[static_cast<std::size_t>(k)];
    for (int r = 0; r < 3; ++r) ut[r][0] += sign * z[r].x, ut[r][1] += sign * z[r].y, ut[r][2] += sign * z[r].z;
    const Vec3 x = cross({z[0].x, z[1].x, z[2].x}, n), y = cross({z[0].y, z[1].y, z[2].y}, n),
               last = cross({z[0].z, z[1].z, z[2].z}, n);
    tt[0] += x.x, tt[1] += y.y, tt[2] += last.z, tt[3] += last.y, tt[4] += last.x, tt[5] += y.x;
  }
  static constexpr int place[3][3] = {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}};
  const auto d = sides_.scale(grain);
  Lower lower{};
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c <= r; ++c) {
      lower[Triangle::at(r, c)] = d(r) * d(c) * uu[place[r][c]];
      lower[Triangle::at(3 + r, 3 + c)] = d(3 + r) * d(3 + c) * tt[place[r][c]];
    }
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) lower[Triangle::at(3 + c, r)] = d(r) * d(3 + c) * ut[r][c];
  return lower;
}

/// S_i^(2^squarings) of all grains with matrices.
std::vector<WeightedContacts::Power> WeightedContacts::powers(int squarings) const {
  std::vector<Power> rows(grains_.size());
  const auto groups = static_cast<std::ptrdiff_t>(groups_of(rows.size()));
#pragma omp parallel for schedule(static) if (groups > 256)
  for (std::ptrdiff_t group = 0; group < groups; ++group) {
    const std::size_t first = lanes * static_cast<std::size_t>(group), count = std::min(lanes, rows.size() - first);
    Gathered<21> g;
    for (std::size_t l = 0; l < lanes; ++l) {
      const Lower row = lower_triangle(grains_[first + std::min(l, count - 1)]);
      for (std::size_t k = 0; k < 21; ++k) g.value[k][l] = row[k];
    }
    Triangle power;
    for (std::size_t k = 0; k < 21; ++k) power.a[k] = g[k];
    Batch log_scale = natural_logarithm(normalise(power));
    for (int s = 0; s < squarings; ++s) {
      power = square(power);
      log_scale = log_scale + log_scale + natural_logarithm(normalise(power));
    }
    for (std::size_t k = 0; k < 21; ++k) store_lanes(g.value[k], power.a[k]);
    for (std::size_t l = 0; l < count; ++l) {
      for (std::size_t k = 0; k < 21; ++k) rows[first + l].lower[k] = g.value[k][l];
      rows[first + l].log_scale = log_scale[l];
    }
  }
  return rows;
}

/// How many times 1/(q + 1) of the way to T* a sweep may go: S_i^q changes as T^q times the share of one contact in
/// S_i.
double WeightedContacts::reach(Index spring) const {
  const Spring& s = sides_.network().springs[spring];
  return std::clamp(0.5 * static_cast<double>(std::min(sides_.of(s.i).size(), sides_.of(s.j).size())), 2.0, 5.0);
}

void WeightedContacts::sweep(int squarings) {
  const std::vector<Power> power = powers(squarings);
  const double per_reach = 1 / (std::exp2(squarings) + 1);
  const auto& network = sides_.network();
  const auto groups = static_cast<std::ptrdiff_t>(groups_of(pairs_.size()));
#pragma omp parallel for schedule(static) if (groups > 256)
  for (std::ptrdiff_t group = 0; group < groups; ++group) {
    const std::size_t first = lanes * static_cast<std::size_t>(group), count = std::min(lanes, pairs_.size() - first);
    const Index* which = &weights_.matrix_spring[first];
    const EightSprings springs(network.springs, which, count);
    const auto wish = [&](auto end, Batch arm, double sign, Batch& log_scale) {
      Gathered<21> p;
      Gathered<3> scale;
      for (std::size_t l = 0; l < lanes; ++l) {
        const Index grain = network.springs[which[std::min(l, count - 1)]].*end;
        const Power& row = power[place_[grain]];
        for (std::size_t k = 0; k < 21; ++k) p.value[k][l] = row.lower[k];
        scale.value[2][l] = row.log_scale;
        scale.value[0][l] = sign * std::sqrt(network.inverse_mass[grain]);
        scale.value[1][l] = network.rotation ? std::sqrt(network.inverse_inertia[grain]) : 0;
      }
      log_scale = scale[2];
      return sandwich(seen_from_contact(p, springs.n, scale[0], arm * scale[1]), springs.root, springs.excess,
                      springs.n);
    };
    Batch log_a, log_b, step;
    for (std::size_t l = 0; l < lanes; ++l)
      step.v[l] = std::min(farthest, reach(which[std::min(l, count - 1)]) * per_reach);
    const Symmetric3 a = wish(&Spring::i, springs.arm_i, -1, log_a), b = wish(&Spring::j, springs.arm_j, 1, log_b);
    const Symmetric3 now = load_matrices(weights_.matrix, first, count), last = load_matrices(before_, first, count);
    for (std::size_t l = 0; l < count; ++l) before_[first + l] = weights_.matrix[first + l];
    const Symmetric3 t = moved(now, a, b, log_a, log_b, step) + (now + last * Batch(-1.0)) * Batch(momentum);
    const Symmetric3 back = inverse(t);
    store(first, count, t, back, is_fit(t, back));
  }
}

void WeightedContacts::update(BlockRanges& ranges) const {
  const auto size = static_cast<std::ptrdiff_t>(grains_.size());
#pragma omp parallel for schedule(static) if (size > 256)
  for (std::ptrdiff_t k = 0; k < size; ++k) {
    const Index g = grains_[static_cast<std::size_t>(k)];
    const Block sum = block(g);
    BlockPower power(sum);
    for (int s = 0; s < 5; ++s) power.square();
    ranges.low[g] = power.trace_ratio(sum);
    ranges.high[g] = power.trace_root() * (1 + 1e-10);
  }
}

SplittingBound WeightedContacts::bound(const BlockRanges& ranges) const {
  SplittingBound maximum;
  std::vector<Index> candidates;
  const double least = ranges.low.empty() ? 0 : *std::max_element(ranges.low.begin(), ranges.low.end());
  for (std::size_t g = 0; g < sides_.size(); ++g)
    if (!sides_.of(g).empty() && ranges.high[g] >= least) candidates.push_back(static_cast<Index>(g));
  std::stable_sort(candidates.begin(), candidates.end(),
                   [&](Index a, Index b) { return ranges.low[a] > ranges.low[b]; });
  for (const Index g : candidates) {
    const std::size_t terms = sides_.of(g).size();
    if (ranges.high[g] < maximum.value) continue;
    const Block sum = block(g);
    if (block_is_below(sum, terms, maximum.value)) continue;
    const double value = block_upper_bound(sum, terms);
    if (value > maximum.value) maximum.value = value, maximum.grain = g;
  }
  return maximum;
}

}  // namespace eg
