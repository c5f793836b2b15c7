#include "state/gather.hpp"

#include <cmath>

#include "contact/laws.hpp"
#include "state/wall_geometry.hpp"

namespace eg {
namespace {

/// A body of mass m ≥ ¾ K Δt², or a servo that takes no more than ⅔ of the way at once, adds no more to λmax than half
/// the stiffness of its contacts again (docs/walls.md).
constexpr double yielding = 1.5;

template <class Law>
class Gatherer {
 public:
  Gatherer(const Scene& scene, const State& state)
      : state_(state), kinds_(scene.materials.size()), arms_(arms_of(scene)) {
    for (std::size_t a = 0; a < kinds_; ++a)
      for (std::size_t b = 0; b < kinds_; ++b) {
        Material ma = scene.materials[a], mb = scene.materials[b];
        if (!state.friction.empty()) ma.friction = state.friction[a], mb.friction = state.friction[b];
        constants_.push_back(Law::constants(ma, mb, scene.dimension));
      }
    if (!state.glued.empty()) glued_to_.assign(state.grains.size(), no_index);
    for (const auto& g : state.glued) glued_to_[g.grain] = g.body;
  }

  void pair(std::size_t c, const std::function<void(const ContactPoint&)>& visit, const OverlapGrowth& growth) const {
    const auto& list = state_.contacts;
    const auto& g = state_.grains;
    if (list.is_padding(c)) return;
    ContactPoint p;
    if (!glued_to_.empty() && (glued_gives(list.i[c]) || glued_gives(list.j[c]))) p.give = yielding;
    p.i = list.i[c], p.j = list.j[c], p.entry = c;
    p.branch = g.position[p.j].vec() + state_.cell.shift(list.image_of(c)) - g.position[p.i].vec();
    p.geometry = grain_grain(p.branch, g.radius(p.i), g.radius(p.i) + g.radius(p.j), arms_);
    if (list.history_vectors > 0) p.shear = {list.history_at(c, 0), list.history_at(c, 1), list.history_at(c, 2)};
    const auto pair = Law::template pair<double>(constants_[g.material_of(p.i) * kinds_ + g.material_of(p.j)],
                                                 grain_sizes(g.radius(p.i), g.radius(p.j)));
    respond(p, pair, visit, growth);
  }

  void wall(std::size_t c, const std::function<void(const ContactPoint&)>& visit, const OverlapGrowth& growth) const {
    const auto& g = state_.grains;
    const auto& contact = state_.wall_contacts[c];
    const Wall& wall = state_.walls[contact.wall];
    ContactPoint p;
    p.i = contact.grain, p.j = no_index, p.wall = contact.wall, p.entry = c;
    const double radius = g.radius(p.i);
    p.geometry = grain_wall(state_, wall, g.position[p.i].vec(), radius, arms_);
    p.branch = p.geometry.n * (radius - p.geometry.overlap);
    if (state_.bodies[wall.body].yields) p.give = yielding;
    if (state_.contacts.history_vectors > 0) p.shear = {contact.history[0], contact.history[1], contact.history[2]};
    respond(p, Law::template pair<double>(constants_[g.material_of(p.i) * kinds_ + wall.material], wall_sizes(radius)),
            visit, growth);
  }

 private:
  void respond(ContactPoint& p, const typename Law::template Pair<double>& pair,
               const std::function<void(const ContactPoint&)>& visit, const OverlapGrowth& growth) const {
    p.reach = p.geometry.overlap;
    if (growth) p.reach = foreseen(p.geometry.overlap, growth(p), pair);
    if (!(p.reach > 0)) return;
    p.normal = Law::template normal<double>(pair, p.reach);
    if (state_.contacts.history_vectors == 0) p.normal.tangential = 0;  // a frictionless scene has no shear
    p.normal_energy = Law::normal_energy(pair, p.reach);
    p.limit = pair.friction * p.normal.force;
    visit(p);
  }

  /// The overlap grown, but no further than to where the energy is taken up. With U ~ δ^q, q = Nδ/U, the step back is
  /// exact for the power laws of springs and Hertz contacts; others come near in a few.
  static double foreseen(double overlap, const OverlapForecast& f, const typename Law::template Pair<double>& pair) {
    double reach = overlap + f.growth;
    if (!(reach > 0) || !std::isfinite(f.energy)) return reach;
    const double most = f.energy + (overlap > 0 ? 2 * Law::normal_energy(pair, overlap) : 0.0);
    for (int step = 0; step < 4; ++step) {
      const double stored = Law::normal_energy(pair, reach);
      if (stored <= most * (1 + 1e-6)) break;
      const double force = Law::template normal<double>(pair, reach).force;
      reach = std::max(overlap + f.driven, reach * std::pow(most / stored, stored / (force * reach)));
    }
    return reach;
  }

  bool glued_gives(Index grain) const { return glued_to_[grain] != no_index && state_.bodies[glued_to_[grain]].yields; }

  const State& state_;
  std::vector<Index> glued_to_;  ///< body of every grain; empty when nothing is glued
  std::size_t kinds_;
  Arms arms_;
  std::vector<typename Law::template Constants<double>> constants_;
};

}  // namespace

void visit_contacts(const Scene& scene, const State& state, const std::function<void(const ContactPoint&)>& visit,
                    const OverlapGrowth& growth) {
  with_law(scene.contact.law, [&]<class Law>(Law) {
    const Gatherer<Law> gatherer(scene, state);
    for (std::size_t c = 0; c < state.contacts.size(); ++c) gatherer.pair(c, visit, growth);
    for (std::size_t c = 0; c < state.wall_contacts.size(); ++c) gatherer.wall(c, visit, growth);
  });
}

void visit_contacts(const Scene& scene, const State& state, const ContactSelection& selection,
                    const std::function<void(const ContactPoint&)>& visit, const OverlapGrowth& growth) {
  with_law(scene.contact.law, [&]<class Law>(Law) {
    const Gatherer<Law> gatherer(scene, state);
    for (const std::size_t c : selection.grains) gatherer.pair(c, visit, growth);
    for (const std::size_t c : selection.walls) gatherer.wall(c, visit, growth);
  });
}

Arms arms_of(const Scene& scene) { return scene.contact.arms == "radius" ? Arms::surface : Arms::middle; }

}  // namespace eg
