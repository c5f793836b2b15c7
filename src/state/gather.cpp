#include "state/gather.hpp"

#include <cmath>

#include "contact/laws.hpp"
#include "state/friction.hpp"
#include "state/wall_geometry.hpp"
#include "state/yielding.hpp"

namespace eg {
namespace {

template <class Law>
class Gatherer {
 public:
  Gatherer(const Scene& scene, const State& state)
      : state_(state),
        kinds_(scene.materials.size()),
        arms_(arms_of(scene)),
        constants_(pair_constants<Law>(scene.materials, friction_in_force(scene, state), scene.dimension)),
        yields_(glued_that_yield(state)) {}

  void pair(std::size_t c, const std::function<void(const ContactPoint&)>& visit) const {
    const auto& list = state_.contacts;
    const auto& g = state_.grains;
    if (list.is_padding(c)) return;
    ContactPoint p;
    if (!yields_.empty() && (yields_[list.i[c]] | yields_[list.j[c]]) != 0) p.give = yielding;
    p.i = list.i[c], p.j = list.j[c], p.entry = c;
    p.branch = g.position[p.j].vec() + state_.cell.shift(list.image_of(c)) - g.position[p.i].vec();
    p.geometry = grain_grain(p.branch, g.radius(p.i), g.radius(p.i) + g.radius(p.j), arms_);
    auto pair = Law::template pair<double>(constants_[g.material_of(p.i) * kinds_ + g.material_of(p.j)],
                                           grain_sizes(g.radius(p.i), g.radius(p.j)));
    if (!list.friction.empty()) pair.friction *= list.friction[c];
    respond(
        p, pair, [&](std::size_t h) { return list.history_at(c, h); }, visit);
  }

  void wall(std::size_t c, const std::function<void(const ContactPoint&)>& visit) const {
    const auto& g = state_.grains;
    const auto& contact = state_.wall_contacts[c];
    const Wall& wall = state_.walls[contact.wall];
    ContactPoint p;
    p.i = contact.grain, p.j = no_index, p.wall = contact.wall, p.entry = c;
    const double radius = g.radius(p.i);
    p.geometry = grain_wall(state_, wall, g.position[p.i].vec(), radius, arms_);
    p.branch = p.geometry.n * (radius - p.geometry.overlap);
    if (state_.bodies[wall.body].yields) p.give = yielding;
    auto pair = Law::template pair<double>(constants_[g.material_of(p.i) * kinds_ + wall.material], wall_sizes(radius));
    pair.friction *= contact.friction;
    respond(
        p, pair, [&](std::size_t h) { return contact.history[h]; }, visit);
  }

 private:
  template <class History>
  void respond(ContactPoint& p, const typename Law::template Pair<double>& pair, const History& stored,
               const std::function<void(const ContactPoint&)>& visit) const {
    const double overlap = p.geometry.overlap;
    bool acts = overlap > 0;
    if constexpr (HasBonds<Law>) acts = acts || stored(Law::bond_value) > 0;
    if (!acts) return;
    Standing s;
    if (state_.contacts.history_vectors == 0) {
      s = standing_springs<Frictionless<Law>>(pair, overlap, {});
    } else if constexpr (HasCouples<Law>) {
      ContactHistory<Law, double> history;
      for (std::size_t h = 0; h < history.size(); ++h) history[h] = stored(h);
      s = Law::at_rest(pair, overlap, history);
    } else {
      s = standing_springs<Law>(pair, overlap, {stored(0), stored(1), stored(2)});
    }
    p.normal = s.normal, p.shear = s.shear, p.rolling = s.rolling, p.twisting = s.twisting;
    p.normal_energy = s.normal_energy, p.shear_energy = s.shear_energy, p.bonded = s.bonded;
    p.limit = pair.friction * p.normal.force;
    visit(p);
  }

  const State& state_;
  std::size_t kinds_;
  Arms arms_;
  std::vector<typename Law::template Constants<double>> constants_;
  std::vector<std::uint8_t> yields_;
};

}  // namespace

void visit_contacts(const Scene& scene, const State& state, const std::function<void(const ContactPoint&)>& visit) {
  with_law(scene.contact.law, [&]<class Law>(Law) {
    const Gatherer<Law> gatherer(scene, state);
    for (std::size_t c = 0; c < state.contacts.size(); ++c) gatherer.pair(c, visit);
    for (std::size_t c = 0; c < state.wall_contacts.size(); ++c) gatherer.wall(c, visit);
  });
}

void visit_contacts(const Scene& scene, const State& state, const ContactSelection& selection,
                    const std::function<void(const ContactPoint&)>& visit) {
  with_law(scene.contact.law, [&]<class Law>(Law) {
    const Gatherer<Law> gatherer(scene, state);
    for (const std::size_t c : selection.grains) gatherer.pair(c, visit);
    for (const std::size_t c : selection.walls) gatherer.wall(c, visit);
  });
}

Arms arms_of(const Scene& scene) { return scene.contact.arms == "radius" ? Arms::surface : Arms::middle; }

}  // namespace eg
