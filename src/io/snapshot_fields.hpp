#pragma once
// The one list of what a snapshot holds of a State: the same lines write and read it. Structures are taken apart by
// structured bindings, so that a field added to one of them does not compile until it is stored here. Private to io.
#include <type_traits>

#include "state/state.hpp"

namespace eg {

/// The vector part of a quad.
template <class Q>
struct VectorPart {
  Q& quad;
};
inline constexpr auto vector_part = [](auto& quad) {
  return VectorPart<std::remove_reference_t<decltype(quad)>>{quad};
};
inline constexpr auto scalar_part = [](auto& quad) -> auto& { return quad.w; };

template <class Archive, class C>
void visit_cell(Archive& a, C& cell) {
  auto& [h, h_low, periodic, origin, strain, strain_low, rate] = cell;
  a.value("cell/matrix", "m", h);
  a.value("cell/matrix_lost", "m", h_low);
  a.value("cell/periodic", "-", periodic);
  a.value("cell/origin", "m", origin);
  a.value("cell/stage_strain", "-", strain);
  a.value("cell/stage_strain_lost", "-", strain_low);
  a.value("cell/rate", "1/s", rate);
}

template <class Archive, class G>
void visit_grains(Archive& a, G& grains) {
  auto& [position, velocity, spin, id, material] = grains;
  a.column("grains/position", "m", position, vector_part);
  a.column("grains/radius", "m", position, scalar_part);
  a.column("grains/velocity", "m/s", velocity, vector_part);
  a.column("grains/inverse_mass", "1/kg", velocity, scalar_part);
  a.column("grains/spin", "rad/s", spin, vector_part);
  a.column("grains/inverse_inertia", "1/(kg m^2)", spin, scalar_part);
  a.array("grains/id", "-", id);
  a.array("grains/material", "-", material);
}

template <class Archive, class C>
void visit_contacts(Archive& a, C& contacts) {
  [[maybe_unused]] auto& [i, j, image, history, friction, chunk_begin, history_size, history_vectors, bond_value,
                          tail_vectors] = contacts;
  a.array("contacts/i", "-", i);
  a.array("contacts/j", "-", j);
  a.array("contacts/image", "-", image);
  a.array("contacts/chunk_begin", "-", chunk_begin);
  a.value("contacts/history_vectors", "-", history_vectors);
  a.value("contacts/bond_value", "-", bond_value);
  a.value("contacts/tail_vectors", "-", tail_vectors);
  a.array("contacts/friction", "-", friction);
  a.history("contacts/history", "N", contacts);  // a row a contact, whatever the blocks in memory; sets history_size
}

template <class Archive, class L>
void visit_list(Archive& a, L& list) {
  auto& [begin, j, image, skin, contact_skin, longest, used, grown, reference, reference_cell, builds, refreshes,
         refreshed] = list;
  a.array("list/begin", "-", begin);
  a.array("list/j", "-", j);
  a.array("list/image", "-", image);
  a.value("list/skin", "m", skin);
  a.value("list/contact_skin", "m", contact_skin);
  a.value("list/longest", "m", longest);
  a.value("list/used", "m", used);
  a.value("list/grown", "m", grown);
  a.array("list/reference", "m", reference);
  a.value("list/reference_cell", "m", reference_cell);
  a.value("list/builds", "-", builds);
  a.value("list/refreshes", "-", refreshes);
  a.value("list/refreshed", "-", refreshed);
}

template <class Archive, class B>
void visit_bodies(Archive& a, B& bodies) {
  [[maybe_unused]] const auto [velocity, opening, force, spread, magnitude, stiffness, glued_stiffness, moved, opened,
                               mass, free, follow, inside, correction, yields] = Body{};  // all its fields
  a.column(
      "bodies/velocity", "m/s", bodies, [](auto& b) -> auto& { return b.velocity; });
  a.column(
      "bodies/opening", "m/s", bodies, [](auto& b) -> auto& { return b.opening; });
  a.column(
      "bodies/force", "N", bodies, [](auto& b) -> auto& { return b.force; });
  a.column(
      "bodies/spread", "N", bodies, [](auto& b) -> auto& { return b.spread; });
  a.column(
      "bodies/magnitude", "N", bodies, [](auto& b) -> auto& { return b.magnitude; });
  a.column(
      "bodies/stiffness", "N/m", bodies, [](auto& b) -> auto& { return b.stiffness; });
  a.column(
      "bodies/glued_stiffness", "N/m", bodies, [](auto& b) -> auto& { return b.glued_stiffness; });
  a.column(
      "bodies/moved", "m", bodies, [](auto& b) -> auto& { return b.moved; });
  a.column(
      "bodies/opened", "m", bodies, [](auto& b) -> auto& { return b.opened; });
  a.column(
      "bodies/mass", "kg", bodies, [](auto& b) -> auto& { return b.mass; });
  a.column(
      "bodies/free", "-", bodies, [](auto& b) -> auto& { return b.free; });
  a.column(
      "bodies/follow", "m/s", bodies, [](auto& b) -> auto& { return b.follow; });
  a.column(
      "bodies/inside", "Pa", bodies, [](auto& b) -> auto& { return b.inside; });
  a.column(
      "bodies/correction", "Pa", bodies, [](auto& b) -> auto& { return b.correction; });
  a.column(
      "bodies/yields", "-", bodies, [](auto& b) -> auto& { return b.yields; });
}

template <class Archive, class W>
void visit_walls(Archive& a, W& walls) {
  [[maybe_unused]] const auto [shape, point, normal, radius, hollow, angle, side_b, side_c, length, owned, spoke,
                               spokes, along, low, high, body, material, moved] = Wall{};  // all its fields
  a.column(
      "walls/shape", "-", walls, [](auto& w) -> auto& { return w.shape; });
  a.column(
      "walls/point", "m", walls, [](auto& w) -> auto& { return w.point; });
  a.column(
      "walls/normal", "-", walls, [](auto& w) -> auto& { return w.normal; });
  a.column(
      "walls/radius", "m", walls, [](auto& w) -> auto& { return w.radius; });
  a.column(
      "walls/hollow", "-", walls, [](auto& w) -> auto& { return w.hollow; });
  a.column(
      "walls/angle", "rad", walls, [](auto& w) -> auto& { return w.angle; });
  a.column(
      "walls/side_b", "m", walls, [](auto& w) -> auto& { return w.side_b; });
  a.column(
      "walls/side_c", "m", walls, [](auto& w) -> auto& { return w.side_c; });
  a.column(
      "walls/length", "m", walls, [](auto& w) -> auto& { return w.length; });
  a.column(
      "walls/owned", "-", walls, [](auto& w) -> auto& { return w.owned; });
  a.column(
      "walls/spoke", "-", walls, [](auto& w) -> auto& { return w.spoke; });
  a.column(
      "walls/spokes", "-", walls, [](auto& w) -> auto& { return w.spokes; });
  a.column(
      "walls/along", "-", walls, [](auto& w) -> auto& { return w.along; });
  a.column(
      "walls/low", "m", walls, [](auto& w) -> auto& { return w.low; });
  a.column(
      "walls/high", "m", walls, [](auto& w) -> auto& { return w.high; });
  a.column(
      "walls/body", "-", walls, [](auto& w) -> auto& { return w.body; });
  a.column(
      "walls/material", "-", walls, [](auto& w) -> auto& { return w.material; });
  a.column(
      "walls/moved", "m", walls, [](auto& w) -> auto& { return w.moved; });
}

template <class Archive, class W>
void visit_wall_contacts(Archive& a, W& contacts) {
  [[maybe_unused]] const auto [grain, wall, history, friction] = WallContact{};  // all its fields
  a.column(
      "wall_contacts/grain", "-", contacts, [](auto& c) -> auto& { return c.grain; });
  a.column(
      "wall_contacts/wall", "-", contacts, [](auto& c) -> auto& { return c.wall; });
  a.column(
      "wall_contacts/history", "N", contacts, [](auto& c) -> auto& { return c.history; });
  a.column(
      "wall_contacts/friction", "-", contacts, [](auto& c) -> auto& { return c.friction; });
}

template <class Archive, class G>
void visit_glued(Archive& a, G& glued) {
  [[maybe_unused]] const auto [grain, body] = GluedGrain{};  // all its fields
  a.column(
      "glued/grain", "-", glued, [](auto& g) -> auto& { return g.grain; });
  a.column(
      "glued/body", "-", glued, [](auto& g) -> auto& { return g.body; });
}

template <class Archive, class M, class F>
void visit_membrane(Archive& a, M& membrane, F& applied) {
  auto& [stress, area, net, moment, volume, solid] = membrane;
  a.value("membrane/stress", "Pa", stress);
  a.value("membrane/area", "m^2", area);
  a.value("membrane/net", "N", net);
  a.value("membrane/moment", "J", moment);
  a.value("membrane/volume", "m^3", volume);
  a.value("membrane/solid", "m^3", solid);
  [[maybe_unused]] const auto [grain, force] = AppliedForce{};  // all its fields
  a.column(
      "applied/grain", "-", applied, [](auto& f) -> auto& { return f.grain; });
  a.column(
      "applied/force", "N", applied, [](auto& f) -> auto& { return f.force; });
}

template <class Archive, class L>
void visit_ledger(Archive& a, L& ledger) {
  auto& [shear_work, friction, local_damping, mass_damping, viscous_damping, boundary, body] = ledger;
  a.value("ledger/shear_work", "J", shear_work);
  a.value("ledger/friction", "J", friction);
  a.value("ledger/local_damping", "J", local_damping);
  a.value("ledger/mass_damping", "J", mass_damping);
  a.value("ledger/viscous_damping", "J", viscous_damping);
  a.value("ledger/boundary", "J", boundary);
  a.value("ledger/body", "J", body);
}

template <class Archive, class P>
void visit_plan(Archive& a, P& plan) {
  auto& [dt, safe, unsafe, cause, made, due, check, ahead, lifetime, room, refreshes, bound] = plan;
  a.value("policy/dt", "s", dt);
  a.value("policy/safe", "s", safe);
  a.value("policy/unsafe", "s", unsafe);
  a.value("policy/cause", "-", cause);
  a.value("policy/made", "-", made);
  a.value("policy/due", "-", due);
  a.value("policy/check", "-", check);
  a.value("policy/ahead", "-", ahead);
  a.value("policy/lifetime", "-", lifetime);
  a.value("policy/room", "-", room);
  a.value("policy/refreshes", "-", refreshes);
  auto& [value, step, overlap, weight, wall_overlap, grain, usual] = bound;
  a.value("policy/bound", "1/s^2", value);
  a.value("policy/bound_step", "s", step);
  a.value("policy/usual_overlap", "m", usual);
  a.array("policy/allowed_overlap", "m", overlap);
  a.array("policy/weight", "-", weight);
  a.array("policy/wall_allowed_overlap", "m", wall_overlap);
  a.array("policy/grain_bound", "1/s^2", grain);
}

template <class Archive, class F>
void visit_friction_scatter(Archive& a, F& scatter) {
  auto& [deviation, by_grain, seed] = scatter;
  a.value("friction_scatter/deviation", "-", deviation);
  a.value("friction_scatter/by_grain", "-", by_grain);
  a.value("friction_scatter/seed", "-", seed);
}

template <class Archive, class B>
void visit_bonds(Archive& a, B& bonds) {
  auto& [made, pulled, cut] = bonds;
  a.value("bonds/made", "-", made);
  a.value("bonds/pulled", "-", pulled);
  a.value("bonds/cut", "-", cut);
}

/// Archive has value(name, unit, number or array of numbers), array(name, unit, vector), column(name, unit, vector of
/// structures, projection) and history(name, unit, contacts); S is State or const State.
template <class Archive, class S>
void visit_state(Archive& a, S& state) {
  auto& [dimension, time, step, dt, cell, grains, contacts, list, bodies, walls, spokes, wall_contacts, glued, membrane,
         applied, virial, stiffness_sum, ledger, friction, friction_scatter, bonds, stage, stage_step, stage_time,
         unbalanced, kinetic, policy, servo, cycle, preparation] = state;
  a.value("dimension", "-", dimension);
  a.value("time", "s", time);
  a.value("step", "-", step);
  a.value("dt", "s", dt);
  a.value("unbalanced", "-", unbalanced);
  a.value("kinetic", "J", kinetic);
  visit_cell(a, cell);
  visit_grains(a, grains);
  visit_contacts(a, contacts);
  visit_list(a, list);
  visit_bodies(a, bodies);
  visit_walls(a, walls);
  a.array("spokes", "-", spokes);
  visit_wall_contacts(a, wall_contacts);
  visit_glued(a, glued);
  visit_membrane(a, membrane, applied);
  a.value("virial", "J", virial);
  a.value("stiffness_sum", "J", stiffness_sum);
  visit_ledger(a, ledger);
  a.array("friction", "-", friction);
  visit_friction_scatter(a, friction_scatter);
  visit_bonds(a, bonds);
  a.value("stage/number", "-", stage);
  a.value("stage/step", "-", stage_step);
  a.value("stage/time", "s", stage_time);
  visit_plan(a, policy);
  a.value("stage/servo", "1/s", servo);
  a.value("stage/direction", "-", cycle.direction);
  a.value("stage/turns", "-", cycle.turns);
  auto& [settled, met, size, growth, grown_until] = preparation;
  a.value("preparation/settled", "-", settled);
  a.value("preparation/met", "-", met);
  a.value("preparation/size", "-", size);
  a.value("preparation/growth", "1/s", growth);
  a.value("preparation/grown_until", "s", grown_until);
}

}  // namespace eg
