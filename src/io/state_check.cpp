#include "io/state_check.hpp"

#include <fmt/format.h>

#include <cmath>
#include <span>
#include <string_view>

#include "base/error.hpp"

namespace eg {

namespace {

bool finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

class Check {
 public:
  explicit Check(const std::string& file) : file_(file) {}

  template <class T>
  void require(bool holds, std::string_view name, const T& value, std::string_view rule) const {
    if (!holds)
      throw input_error(file_, 0, fmt::format("{} = {}", name, value), rule,
                        "the file is damaged; use another snapshot");
  }
  /// `size` must be n, or 0 where the array may be left out.
  void length(std::string_view name, std::size_t size, std::size_t n, bool may_be_empty = false) const {
    require(size == n || (may_be_empty && size == 0), fmt::format("length of {}", name), size,
            fmt::format("must be {}", n));
  }
  template <class Values, class Project = std::identity>
  void below(std::string_view name, const Values& values, std::size_t limit, Project number = {}) const {
    for (std::size_t k = 0; k < values.size(); ++k)
      if (const std::size_t x = number(values[k]); x >= limit)
        require(false, fmt::format("{}[{}]", name, k), x, fmt::format("must be below {}", limit));
  }
  /// Rows of a list: ascending from 0 to `end`; empty when there is nothing.
  void offsets(std::string_view name, std::span<const std::uint64_t> begin, std::size_t end) const {
    if (begin.empty()) return require(end == 0, fmt::format("length of {}", name), 0, "must not be 0");
    for (std::size_t k = 0; k < begin.size(); ++k)
      if (begin[k] < (k > 0 ? begin[k - 1] : 0) || begin[k] > end)
        require(false, fmt::format("{}[{}]", name, k), begin[k], fmt::format("must ascend to {}", end));
    require(begin.back() == end, fmt::format("last of {}", name), begin.back(), fmt::format("must be {}", end));
  }
  void finite_values(std::string_view name, std::span<const double> values) const {
    for (std::size_t k = 0; k < values.size(); ++k)
      if (!std::isfinite(values[k])) require(false, fmt::format("{}[{}]", name, k), values[k], "must be finite");
  }

 private:
  const std::string& file_;
};

void check_cell(const Check& check, const Cell& cell) {
  check.finite_values("cell/matrix", cell.h.a);
  check.finite_values("cell/rate", cell.rate.a);
  for (int k = 0; k < 3; ++k) check.require(cell.h(k, k) > 0, "cell/matrix diagonal", cell.h(k, k), "must be > 0");
}

void check_grains(const Check& check, const Grains& grains, std::size_t materials) {
  const std::size_t n = grains.size();
  check.length("grains/velocity", grains.velocity.size(), n);
  check.length("grains/id", grains.id.size(), n);
  check.length("grains/spin", grains.spin.size(), n, true);
  check.length("grains/material", grains.material.size(), n, true);
  check.below("grains/material", grains.material, materials);
  const auto moves = [&](std::string_view name, std::size_t i, const Quad& q) {
    check.require(finite(q.vec()) && std::isfinite(q.w) && q.w >= 0, fmt::format("{}[{}]", name, i),
                  fmt::format("({}, {}, {}; {})", q.x, q.y, q.z, q.w), "must be finite, the inverse mass not negative");
  };
  for (std::size_t i = 0; i < n; ++i) {
    const Quad& q = grains.position[i];
    if (!finite(q.vec()))
      check.require(false, fmt::format("grains/position[{}]", i), fmt::format("({}, {}, {})", q.x, q.y, q.z),
                    "must be finite");
    if (!(q.w > 0) || !std::isfinite(q.w))
      check.require(false, fmt::format("grains/radius[{}]", i), q.w, "must be > 0");
    moves("grains/velocity", i, grains.velocity[i]);
    if (grains.rotates()) moves("grains/spin", i, grains.spin[i]);
  }
}

void check_contacts(const Check& check, const Contacts& contacts, std::size_t grains) {
  check.length("contacts/j", contacts.j.size(), contacts.size());
  check.length("contacts/image", contacts.image.size(), contacts.size(), true);
  check.length("contacts/friction", contacts.friction.size(), contacts.size(), true);
  check.require(contacts.bond_value == 0 || contacts.bond_value < contacts.history_size, "contacts/bond_value",
                contacts.bond_value, "must be below the number of history values");
  check.below("contacts/i", contacts.i, grains);
  check.below("contacts/j", contacts.j, grains);
  check.below("contacts/image", contacts.image, Cell::images);
  check.offsets("contacts/chunk_begin", contacts.chunk_begin, contacts.size());
  check.finite_values("contacts/history", contacts.history);
}

void check_list(const Check& check, const NeighbourList& list, std::size_t grains) {
  check.length("list/begin", list.begin.size(), grains + 1, true);
  check.offsets("list/begin", list.begin, list.j.size());
  check.length("list/image", list.image.size(), list.j.size(), true);
  check.below("list/j", list.j, grains);
  check.below("list/image", list.image, Cell::images);
  check.length("list/reference", list.reference.size(), grains, true);
}

/// What is allowed must be there for every contact, once a step has been chosen.
void check_plan(const Check& check, const State& state) {
  const StandingBound& bound = state.policy.bound;
  if (!(state.policy.dt > 0)) return;
  check.length("policy/allowed_overlap", bound.overlap.size(), state.contacts.size());
  check.length("policy/weight", bound.weight.size(), state.contacts.size());
  check.length("policy/wall_allowed_overlap", bound.wall_overlap.size(), state.wall_contacts.size());
  check.length("policy/grain_bound", bound.grain.size(), state.grains.size());
}

}  // namespace

void check_state(const Scene& scene, const State& state, const std::string& file) {
  const Check check(file);
  check.require(state.dimension == scene.dimension, "dimension", state.dimension,
                fmt::format("must be that of the scene, {}", scene.dimension));
  check.require(std::isfinite(state.time), "time", state.time, "must be finite");
  check.require(std::isfinite(state.dt) && state.dt >= 0, "dt", state.dt, "must be finite and >= 0");
  check_cell(check, state.cell);
  check_grains(check, state.grains, scene.materials.size());
  check_contacts(check, state.contacts, state.grains.size());
  check_list(check, state.list, state.grains.size());
  check_plan(check, state);
  check.length("bodies", state.bodies.size(), scene.boundary.bodies.size());
  check.below("walls/shape", state.walls, 5, [](const Wall& w) { return w.shape; });
  check.below("walls/body", state.walls, state.bodies.size(), [](const Wall& w) { return w.body; });
  check.below("walls/spoke", state.walls, state.spokes.size() + 1, [](const Wall& w) { return w.spoke + w.spokes; });
  check.below("glued/grain", state.glued, state.grains.size(), [](const auto& g) { return g.grain; });
  check.below("glued/body", state.glued, state.bodies.size(), [](const auto& g) { return g.body; });
  check.below("walls/material", state.walls, scene.materials.size(), [](const Wall& w) { return w.material; });
  check.below("applied/grain", state.applied, state.grains.size(), [](const auto& f) { return f.grain; });
  check.below("wall_contacts/grain", state.wall_contacts, state.grains.size(), [](const auto& c) { return c.grain; });
  check.below("wall_contacts/wall", state.wall_contacts, state.walls.size(), [](const auto& c) { return c.wall; });
  check.length("friction", state.friction.size(), scene.materials.size() * scene.materials.size(), true);
  check.require(state.stage <= scene.stages.size(), "stage/number", state.stage,
                fmt::format("must not pass the number of stages, {}", scene.stages.size()));
}

}  // namespace eg
