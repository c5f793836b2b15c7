#include "state/gather.hpp"

#include <cmath>

#include "contact/laws.hpp"

namespace eg {
namespace {

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
  }

  void grains(const std::function<void(const ContactPoint&)>& visit, const OverlapGrowth& growth) const {
    const auto& list = state_.contacts;
    const auto& g = state_.grains;
    for (std::size_t c = 0; c < list.size(); ++c) {
      if (list.is_padding(c)) continue;
      ContactPoint p;
      p.i = list.i[c], p.j = list.j[c], p.entry = c;
      p.branch = g.position[p.j].vec() + state_.cell.shift(list.image_of(c)) - g.position[p.i].vec();
      p.geometry = grain_grain(p.branch, g.radius(p.i), g.radius(p.i) + g.radius(p.j), arms_);
      if (list.history_vectors > 0) p.shear = {list.history_at(c, 0), list.history_at(c, 1), list.history_at(c, 2)};
      const auto pair = Law::template pair<double>(constants_[g.material_of(p.i) * kinds_ + g.material_of(p.j)],
                                                   grain_sizes(g.radius(p.i), g.radius(p.j)));
      respond(p, pair, visit, growth);
    }
  }

  void walls(const std::function<void(const ContactPoint&)>& visit, const OverlapGrowth& growth) const {
    const auto& g = state_.grains;
    for (std::size_t c = 0; c < state_.wall_contacts.size(); ++c) {
      const auto& contact = state_.wall_contacts[c];
      const Wall& wall = state_.walls[contact.wall];
      ContactPoint p;
      p.i = contact.grain, p.j = no_index, p.wall = contact.wall, p.entry = c;
      const double height = dot(g.position[p.i].vec() - wall.point, wall.normal), radius = g.radius(p.i);
      p.branch = wall.normal * -height;
      p.geometry = grain_plane(height, wall.normal, radius, arms_);
      if (state_.contacts.history_vectors > 0) p.shear = {contact.history[0], contact.history[1], contact.history[2]};
      respond(p,
              Law::template pair<double>(constants_[g.material_of(p.i) * kinds_ + wall.material], wall_sizes(radius)),
              visit, growth);
    }
  }

 private:
  void respond(ContactPoint& p, const typename Law::template Pair<double>& pair,
               const std::function<void(const ContactPoint&)>& visit, const OverlapGrowth& growth) const {
    const double overlap = p.geometry.overlap + (growth ? growth(p.i, p.j, p.geometry) : 0.0);
    if (!(overlap > 0)) return;
    p.normal = Law::template normal<double>(pair, overlap);
    if (state_.contacts.history_vectors == 0) p.normal.tangential = 0;  // a frictionless scene has no shear
    p.normal_energy = Law::normal_energy(pair, overlap);
    p.limit = pair.friction * p.normal.force;
    visit(p);
  }

  const State& state_;
  std::size_t kinds_;
  Arms arms_;
  std::vector<typename Law::template Constants<double>> constants_;
};

}  // namespace

void visit_contacts(const Scene& scene, const State& state, const std::function<void(const ContactPoint&)>& visit,
                    const OverlapGrowth& growth) {
  with_law(scene.contact.law, [&]<class Law>(Law) {
    const Gatherer<Law> gatherer(scene, state);
    gatherer.grains(visit, growth);
    gatherer.walls(visit, growth);
  });
}

Arms arms_of(const Scene& scene) { return scene.contact.arms == "radius" ? Arms::surface : Arms::middle; }

}  // namespace eg
