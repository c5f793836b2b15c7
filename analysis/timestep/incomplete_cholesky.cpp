#include "timestep/incomplete_cholesky.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "timestep/patch.hpp"
#include "timestep/tile.hpp"

namespace eg {
namespace {

constexpr double reserve = 1e-6;  // of σ, for round-off

class Factorisation {
 public:
  Factorisation(const WeightedContacts& contacts, std::span<const Index> patch, double sigma, double drop);
  IncompleteCholesky run();

 private:
  /// From a grain to grains eliminated later; `to` apart, since it is searched.
  struct Links {
    std::vector<Index> to;
    std::vector<Tile> block;  ///< rows: the owner; columns: `to`
    std::size_t size() const { return to.size(); }
    void add(Index grain, const Tile& tile) { to.push_back(grain), block.push_back(tile); }
  };

  void assemble_diagonal(std::size_t k, std::span<const Index> place, double sigma);
  void assemble_links(std::size_t k, std::span<const Index> place);
  bool eliminate(std::size_t k);
  bool drop(std::size_t a, std::size_t b, double size);
  void subtract(std::size_t p, std::size_t q);
  bool round_off_is_covered() const;

  /// The least entry of the diagonal of a grain's block, less what drops took.
  double room(std::size_t k) const { return least_[k] - given_[k]; }
  const WeightedContacts& contacts_;
  const Sides& sides_;
  std::span<const Index> patch_;
  double drop_;
  std::vector<Tile> diagonal_;
  std::vector<double> least_;  ///< entry of the diagonal of a grain's block
  std::vector<double> given_;  ///< what drops have taken from the diagonal of a grain's block
  std::vector<Links> links_;
  Links factor_;                      ///< those of the grain that is being eliminated
  std::vector<double> norm_;          ///< of the factor's blocks (Frobenius)
  std::vector<Index> slot_;           ///< of the marked row: a grain's place among its links, or no_index
  std::vector<std::size_t> updates_;  ///< eliminations that a grain's blocks have seen
  std::vector<std::size_t> drops_;    ///< blocks dropped beside its diagonal block
  std::size_t most_terms_ = 0, most_links_ = 0;
  IncompleteCholesky result_;
};

Factorisation::Factorisation(const WeightedContacts& contacts, std::span<const Index> patch, double sigma, double drop)
    : contacts_(contacts),
      sides_(contacts.sides()),
      patch_(patch),
      drop_(drop),
      diagonal_(patch.size()),
      least_(patch.size()),
      given_(patch.size(), 0),
      links_(patch.size()),
      slot_(patch.size(), no_index),
      updates_(patch.size(), 0),
      drops_(patch.size(), 0) {
  const auto place = places(sides_, patch);
  for (std::size_t k = 0; k < patch.size(); ++k) {
    assemble_diagonal(k, place, sigma);
    assemble_links(k, place);
  }
}

void Factorisation::assemble_diagonal(std::size_t k, std::span<const Index> place, double sigma) {
  const auto& springs = sides_.network().springs;
  const Block block = sides_.block(patch_[k], [&](const Side& side) -> Eigen::Matrix3d {
    const Spring& s = springs[side.spring];
    const bool inside = side.role != Side::Role::alone && place[s.i] != no_index && place[s.j] != no_index;
    return inside ? contact_stiffness(s) : contacts_.weighted_stiffness(side);
  });
  diagonal_[k] = Tile(sigma * (1 - reserve) * Block::Identity() - block);
  least_[k] = diagonal_[k].least_diagonal();
  most_terms_ = std::max(most_terms_, sides_.of(patch_[k]).size());
}

void Factorisation::assemble_links(std::size_t k, std::span<const Index> place) {
  const auto& springs = sides_.network().springs;
  for (const Side& side : sides_.of(patch_[k])) {
    if (side.role == Side::Role::alone) continue;
    const bool first = side.role == Side::Role::first;
    const Spring& s = springs[side.spring];
    const Index other = first ? s.j : s.i, to = place[other];
    if (to == no_index || to <= k) continue;
    const Side far{side.spring, Side::Role::first, first ? ContactSide::second : ContactSide::first, false};
    const Block block =
        -(sides_.scaled_matrix(patch_[k], side).transpose() * contact_stiffness(s) * sides_.scaled_matrix(other, far));
    Links& links = links_[k];
    const auto known = static_cast<std::size_t>(std::ranges::find(links.to, to) - links.to.begin());
    if (known == links.size())
      links.add(to, Tile(block));
    else
      links.block[known] = links.block[known] + Tile(block);
  }
}

/// Takes what dropping a fill block of this size costs from both diagonal blocks, if it is little beside them.
bool Factorisation::drop(std::size_t a, std::size_t b, double size) {
  const double room_a = room(a), room_b = room(b), both = room_a * room_b;
  if (!(room_a > 0 && room_b > 0 && size * size <= drop_ * drop_ * both)) return false;
  const double ratio = room_a / std::sqrt(both);
  given_[a] += size * ratio, given_[b] += size / ratio;
  ++drops_[a], ++drops_[b];
  ++result_.dropped;
  return true;
}

/// Block (a, b) of what is left, a and b the grains at places p < q of the factor's row, becomes itself − W_pᵀ W_q,
/// unless that is fill and can be dropped. Row a is the marked one.
void Factorisation::subtract(std::size_t p, std::size_t q) {
  const Index a = factor_.to[p], b = factor_.to[q];
  constexpr double up = 1 + 1e-13;  // over round-off of a norm
  if (slot_[b] != no_index) {
    links_[a].block[slot_[b]].subtract_product(factor_.block[p], factor_.block[q]);
    return;
  }
  if (drop(a, b, norm_[p] * norm_[q] * up)) return;
  Tile fill;
  fill.subtract_product(factor_.block[p], factor_.block[q]);
  if (!drop(a, b, fill.norm() * up)) links_[a].add(b, fill);
}

bool Factorisation::eliminate(std::size_t k) {
  const Eigen::LLT<Block> cholesky(diagonal_[k].block() - given_[k] * Block::Identity());
  if (cholesky.info() != Eigen::Success) return false;
  const Block lower = cholesky.matrixL();
  factor_ = std::move(links_[k]);
  links_[k] = {};
  most_links_ = std::max(most_links_, factor_.size());
  result_.kept += factor_.size();
  norm_.resize(factor_.size());
  for (std::size_t p = 0; p < factor_.size(); ++p) {
    Tile& w = factor_.block[p];
    const Index to = factor_.to[p];
    w.solve_lower(lower);
    norm_[p] = w.norm();
    diagonal_[to].subtract_product(w, w);
    least_[to] = diagonal_[to].least_diagonal();
    ++updates_[to];
  }
  for (std::size_t p = 0; p < factor_.size(); ++p) {
    const Links& row = links_[factor_.to[p]];
    for (std::size_t l = 0; l < row.size(); ++l) slot_[row.to[l]] = static_cast<Index>(l);
    const std::size_t marked = row.size();
    for (std::size_t q = 0; q < factor_.size(); ++q)
      if (factor_.to[q] > factor_.to[p]) subtract(p, q);
    for (std::size_t l = 0; l < marked; ++l) slot_[row.to[l]] = no_index;
  }
  return true;
}

/// Demmel (1989): the factors are exact for a matrix that differs by at most (m + 8) ε √(a_ii a_jj) an entry, m the
/// terms that went into it. A row has 6 entries for every grain it is linked to, before and after its elimination,
/// which bounds the norm; what drops take from the diagonal is rounded once each.
bool Factorisation::round_off_is_covered() const {
  const auto most = [](const std::vector<std::size_t>& counts) {
    return counts.empty() ? 0.0 : static_cast<double>(*std::max_element(counts.begin(), counts.end()));
  };
  const double updates = most(updates_), terms = 6 * updates + 8 * static_cast<double>(most_terms_) + 64;
  const double row = 6 * (static_cast<double>(most_links_) + updates + 1);
  return 2 * (terms * row + most(drops_)) * std::numeric_limits<double>::epsilon() <= reserve;
}

IncompleteCholesky Factorisation::run() {
  for (std::size_t k = 0; k < patch_.size(); ++k)
    if (!eliminate(k)) return result_;
  result_.below = round_off_is_covered();
  return result_;
}

}  // namespace

IncompleteCholesky factorise_below(const WeightedContacts& contacts, std::span<const Index> patch, double sigma,
                                   double drop) {
  return Factorisation(contacts, patch, sigma, drop).run();
}

}  // namespace eg
