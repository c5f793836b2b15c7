#include "timestep/pressed.hpp"

#include "timestep/presser.hpp"

namespace eg {
namespace {

/// The springs of the present lists, all without stiffness.
Pressed lay_out(const Scene& scene, const State& state) {
  const auto& list = state.contacts;
  Pressed out;
  out.network = bare_network(scene, state);
  auto& springs = out.network.springs;
  bool couples = false;
  with_law(scene.contact.law,
           [&]<class Law>(Law) { couples = HasCouples<Law> && state.grains.rotates() && list.history_vectors > 0; });
  const std::size_t contacts = list.size() + state.wall_contacts.size();
  springs.reserve(couples ? 3 * contacts : contacts);
  const auto add = [&](Index i, Index j, bool couple) {
    Spring s;
    s.i = i, s.j = j, s.couple = couple;
    springs.push_back(s);
  };
  for (std::size_t c = 0; c < list.size(); ++c) add(list.i[c], list.j[c], false);
  for (const auto& w : state.wall_contacts) add(w.grain, no_index, false);
  if (couples) {
    for (std::size_t c = 0; c < contacts; ++c) add(springs[c].i, no_index, true);
    for (std::size_t c = 0; c < list.size(); ++c) add(list.j[c], no_index, true);
  }
  out.couples = couples ? contacts : 0;
  out.motion.assign(springs.size(), {});
  return out;
}

}  // namespace

double centred_weight(double a_i, double room_i, double a_j, double room_j) {
  const double t = std::sqrt((a_j * room_i) / (a_i * room_j));
  return std::isfinite(t) ? std::clamp(t, 1 / presser::widest, presser::widest) : 1.0;
}

double room_below(double sigma, double bound) { return std::max(presser::nearest * sigma, sigma - bound); }

Pressed press_contacts(const Scene& scene, State& state, const PressOptions& options) {
  StandingBound& bound = state.policy.bound;
  const auto& list = state.contacts;
  bound.value = 0;
  bound.overlap.assign(list.size(), 0.0), bound.weight.assign(list.size(), 0.0);
  bound.wall_overlap.assign(state.wall_contacts.size(), 0.0);
  Pressed out = lay_out(scene, state);
  AlignedVector<Quad> grains(state.grains.size());
  with_law(scene.contact.law, [&]<class Law>(Law) {
    presser::Presser<Law> presser(scene, state, options);
    const std::size_t chunks = list.chunk_begin.empty() ? 0 : list.chunk_begin.size() - 1;
#pragma omp parallel if (chunks >= Contacts::worth_threads)
    {
      presser.prepare(grains);
#pragma omp for schedule(static)
      for (std::size_t k = 0; k < chunks; ++k)
        for (std::size_t c = list.chunk_begin[k]; c < list.chunk_begin[k + 1]; c += Contacts::lanes)
          presser.press(c, bound, out);
    }
    for (std::size_t w = 0; w < state.wall_contacts.size(); ++w) presser.press_wall(w, bound, out);
  });
  return out;
}

std::vector<CountedContact> counted_contacts(const Scene& scene, const State& state, const ContactSelection& selection,
                                             double time) {
  std::vector<CountedContact> found;
  with_law(scene.contact.law, [&]<class Law>(Law) {
    const presser::Presser<Law> presser(scene, state, {time, 0});
    for (const std::size_t c : selection.grains) presser.count(c, found);
    for (const std::size_t w : selection.walls) presser.count_wall(w, found);
  });
  return found;
}

void allow(const Scene& scene, State& state, const ContactSelection& selection, const PressOptions& options) {
  StandingBound& bound = state.policy.bound;
  with_law(scene.contact.law, [&]<class Law>(Law) {
    const presser::Presser<Law> presser(scene, state, options);
    for (const std::size_t c : selection.grains) bound.overlap[c] = presser.allowance(c);
    for (const std::size_t w : selection.walls) bound.wall_overlap[w] = presser.wall_allowance(w);
  });
}

}  // namespace eg
