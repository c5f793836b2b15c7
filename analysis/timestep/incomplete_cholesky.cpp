#include "timestep/incomplete_cholesky.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "timestep/patch.hpp"

namespace eg {
namespace {

constexpr double reserve = 1e-6;  // of σ, for round-off

class Factorisation {
 public:
  Factorisation(const WeightedContacts& contacts, std::span<const Index> patch, double sigma, double drop);
  IncompleteCholesky run();

 private:
  struct Link {
    Index to;
    Block block;  ///< rows: the owner; columns: `to`
    double norm;  ///< of the factor's block (Frobenius), once there is one
  };
  using Links = std::vector<Link>;

  void assemble_diagonal(std::size_t k, std::span<const Index> place, double sigma);
  void assemble_links(std::size_t k, std::span<const Index> place);
  bool eliminate(std::size_t k);
  bool drop(std::size_t a, std::size_t b, double size);
  void subtract(const Link& left, const Link& right);
  bool round_off_is_covered() const;

  static Link* find(Links& links, Index to) {
    for (Link& link : links)
      if (link.to == to) return &link;
    return nullptr;
  }
  double room(std::size_t k) const { return diagonal_[k].diagonal().minCoeff(); }

  const WeightedContacts& contacts_;
  const Sides& sides_;
  std::span<const Index> patch_;
  double sigma_, drop_;
  std::vector<Block> diagonal_;
  std::vector<Links> links_;          ///< from a grain to grains eliminated later
  std::vector<std::size_t> updates_;  ///< eliminations that a grain's blocks have seen
  std::vector<std::size_t> drops_;    ///< blocks dropped beside its diagonal block
  std::size_t most_terms_ = 0, most_links_ = 0;
  IncompleteCholesky result_;
};

Factorisation::Factorisation(const WeightedContacts& contacts, std::span<const Index> patch, double sigma, double drop)
    : contacts_(contacts),
      sides_(contacts.sides()),
      patch_(patch),
      sigma_(sigma),
      drop_(drop),
      diagonal_(patch.size()),
      links_(patch.size()),
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
  diagonal_[k] = sigma * (1 - reserve) * Block::Identity() - block;
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
    if (Link* link = find(links_[k], to))
      link->block += block;
    else
      links_[k].push_back({to, block, 0});
  }
}

/// Takes what dropping a fill block of this size costs from both diagonal blocks, if it is little beside them.
bool Factorisation::drop(std::size_t a, std::size_t b, double size) {
  const double room_a = room(a), room_b = room(b);
  if (!(room_a > 0 && room_b > 0 && size <= drop_ * std::sqrt(room_a * room_b))) return false;
  const double ratio = std::sqrt(room_a / room_b);
  diagonal_[a].diagonal().array() -= size * ratio;
  diagonal_[b].diagonal().array() -= size / ratio;
  ++drops_[a], ++drops_[b];
  ++result_.dropped;
  return true;
}

/// Block (a, b) of what is left, a < b, becomes itself − left ᵀright, unless that is fill and can be dropped.
void Factorisation::subtract(const Link& left, const Link& right) {
  Links& links = links_[left.to];
  Link* link = find(links, right.to);
  constexpr double up = 1 + 1e-13;  // over round-off of a norm
  if (!link && drop(left.to, right.to, left.norm * right.norm * up)) return;
  const Block fill = left.block.transpose().lazyProduct(right.block);
  if (link)
    link->block -= fill;
  else if (!drop(left.to, right.to, fill.norm() * up))
    links.push_back({right.to, -fill, 0});
}

bool Factorisation::eliminate(std::size_t k) {
  const Eigen::LLT<Block> cholesky(diagonal_[k]);
  if (cholesky.info() != Eigen::Success) return false;
  Links links = std::move(links_[k]);
  links_[k] = {};
  most_links_ = std::max(most_links_, links.size());
  result_.kept += links.size();
  for (Link& link : links) {
    cholesky.matrixL().solveInPlace(link.block);
    link.norm = link.block.norm();
    diagonal_[link.to].noalias() -= link.block.transpose().lazyProduct(link.block);
    ++updates_[link.to];
  }
  for (std::size_t p = 0; p < links.size(); ++p)
    for (std::size_t q = p + 1; q < links.size(); ++q) {
      const bool ordered = links[p].to < links[q].to;
      subtract(ordered ? links[p] : links[q], ordered ? links[q] : links[p]);
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
