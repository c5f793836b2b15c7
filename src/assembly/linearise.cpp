#include "assembly/linearise.hpp"

#include <array>

#include "contact/lanes.hpp"
#include "contact/laws.hpp"
#include "state/friction.hpp"
#include "state/wall_geometry.hpp"

namespace eg {
namespace {

using D12 = Dual<12>;

Vec<D12> variable(const Vec3& v, std::size_t first) {
  return {D12::variable(v.x, first), D12::variable(v.y, first + 1), D12::variable(v.z, first + 2)};
}
Vec<D12> constant(const Vec3& v) { return {D12(v.x), D12(v.y), D12(v.z)}; }

template <class Law>
TangentBlock tangent(const ContactPoint& p, const State& state,
                     const typename Law::template Constants<double>& constants, Arms arms) {
  const auto& grains = state.grains;
  const bool wall = p.j == no_index;
  const Vec<D12> ui = variable({}, 0), ti = variable({}, 3);
  const Vec<D12> uj = wall ? Vec<D12>{} : variable({}, 6), tj = wall ? Vec<D12>{} : variable({}, 9);
  const D12 ri(grains.radius(p.i)), rj(wall ? 0.0 : grains.radius(p.j));
  Geometry<D12> g;
  if (wall) {
    g = grain_wall<D12>(state, state.walls[p.wall], constant(grains.position[p.i].vec()) + ui, ri, arms);
  } else {
    g = grain_grain<D12>(constant(p.branch) + uj - ui, ri, ri + rj, arms);
  }
  const auto inc = increment<true>(g, motion_of<D12>(uj - ui, ti, ri, tj, rj));
  ContactHistory<Law, D12> history;
  for (std::size_t h = 0; h < history.size(); ++h)
    history[h] = wall ? D12(state.wall_contacts[p.entry].history[h]) : D12(state.contacts.history_at(p.entry, h));
  const auto c = broadcast_struct<typename Law::template Constants<D12>, D12>(constants);
  auto pair = Law::template pair<D12>(c, wall ? wall_sizes(ri) : grain_sizes(ri, rj));
  if (wall)
    pair.friction = pair.friction * D12(state.wall_contacts[p.entry].friction);
  else if (!state.contacts.friction.empty())
    pair.friction = pair.friction * D12(state.contacts.friction[p.entry]);
  const auto f = interact<Law, false>(pair, g, inc, g.overlap > D12(0.0), history, Dashpot<D12>{});

  const Vec<D12> on_i = -f.on_j, moment_i = f.moment * g.arm_i + f.couple, moment_j = f.moment * g.arm_j - f.couple;
  TangentBlock block{p.i, p.j, {}};
  const std::array<const Vec<D12>*, 4> rows{&on_i, &moment_i, &f.on_j, &moment_j};
  for (std::size_t r = 0; r < (wall ? 6u : 12u); ++r)
    for (std::size_t k = 0; k < 12; ++k) block.k[12 * r + k] = -(*rows[r / 3])[static_cast<int>(r % 3)].d[k];
  return block;
}

}  // namespace

Spring spring_of(const ContactPoint& p) {
  const Geometry<double>& g = p.geometry;
  return {p.i, p.j, g.arm_i, g.arm_j, p.normal.stiffness, p.normal.tangential, g.n, norm(p.branch), p.give};
}

Spring couple_of(const ContactPoint& p) {
  return {p.i, p.j, 0, 0, p.twisting, p.rolling, p.geometry.n, norm(p.branch), p.give, true};
}

Network bare_network(const Scene& scene, const State& state) {
  const auto& g = state.grains;
  Network net;
  net.dimension = scene.dimension;
  net.rotation = g.rotates();
  net.inverse_mass.reserve(g.size()), net.radius.reserve(g.size());
  for (std::size_t i = 0; i < g.size(); ++i) {
    net.inverse_mass.push_back(g.velocity[i].w);
    net.radius.push_back(g.radius(i));
    if (net.rotation) net.inverse_inertia.push_back(g.spin[i].w);
  }
  net.id = g.id;
  return net;
}

Network linearise(const Scene& scene, const State& state) {
  Network net = bare_network(scene, state);
  std::vector<Spring> couples;
  visit_contacts(scene, state, [&](const ContactPoint& p) {
    net.springs.push_back(spring_of(p));
    if (net.rotation && p.has_couple()) couples.push_back(couple_of(p));
  });
  net.springs.insert(net.springs.end(), couples.begin(), couples.end());
  return net;
}

std::vector<TangentBlock> consistent_blocks(const Scene& scene, const State& state) {
  std::vector<TangentBlock> blocks;
  with_law(scene.contact.law, [&]<class Law>(Law) {
    const std::size_t kinds = scene.materials.size();
    const auto table = pair_constants<Law>(scene.materials, friction_in_force(scene, state), scene.dimension);
    const Arms arms = arms_of(scene);
    visit_contacts(scene, state, [&](const ContactPoint& p) {
      const auto mi = state.grains.material_of(p.i);
      const auto mj = p.j == no_index ? state.walls[p.wall].material : state.grains.material_of(p.j);
      if (state.contacts.history_vectors == 0)
        blocks.push_back(tangent<Frictionless<Law>>(p, state, table[mi * kinds + mj], arms));
      else
        blocks.push_back(tangent<Law>(p, state, table[mi * kinds + mj], arms));
    });
  });
  return blocks;
}

Eigen::SparseMatrix<double> assemble_blocks(const std::vector<TangentBlock>& blocks, const Network& shape) {
  static constexpr std::array<int, 6> all{0, 1, 2, 3, 4, 5}, flat{0, 1, 5, 0, 0, 0};
  const auto& dofs = shape.dimension == 3 ? all : flat;
  const int n = shape.dofs_per_grain();
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(blocks.size() * static_cast<std::size_t>(4 * n * n));
  for (const auto& b : blocks) {
    const std::array<Index, 2> side{b.i, b.j};
    for (std::size_t r = 0; r < 2; ++r)
      for (std::size_t c = 0; c < 2; ++c) {
        if (side[r] == no_index || side[c] == no_index) continue;
        for (int p = 0; p < n; ++p)
          for (int q = 0; q < n; ++q) {
            const auto row = 6 * r + static_cast<std::size_t>(dofs[static_cast<std::size_t>(p)]);
            const auto column = 6 * c + static_cast<std::size_t>(dofs[static_cast<std::size_t>(q)]);
            entries.emplace_back(static_cast<int>(side[r]) * n + p, static_cast<int>(side[c]) * n + q,
                                 b.k[12 * row + column]);
          }
      }
  }
  const auto size = static_cast<Eigen::Index>(shape.size()) * n;
  Eigen::SparseMatrix<double> k(size, size);
  k.setFromTriplets(entries.begin(), entries.end());
  return k;
}

}  // namespace eg
