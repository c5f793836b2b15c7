#include "waves/transmit.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "dynamics/engine.hpp"
#include "state/gather.hpp"

namespace eg {
namespace {

/// What is moved and what is listened to, as numbers of grains.
struct Array {
  std::vector<Index> source;
  std::vector<std::vector<Index>> receivers;
  std::vector<double> distance;
  double spacing = 0;
};

/// Layers from the source to the far side, or to the middle of a periodic cell, where both ways meet.
Array layer_array(const State& state, int axis) {
  const Layers layers = find_layers(state, axis);
  const std::size_t n = layers.grains.size();
  const bool periodic = state.cell.periodic[static_cast<std::size_t>(axis)];
  const std::size_t count = periodic ? n / 2 + 1 : n;
  if (count < 4) throw InputError("the packing has fewer than four layers along the axis; take more cells or grains");
  Array a;
  a.source = layers.grains[0], a.spacing = layers.spacing;
  for (std::size_t k = 0; k < count; ++k) {
    if (layers.grains[k].empty()) throw InputError("a layer along the axis holds no grain; take a denser packing");
    a.receivers.push_back(layers.grains[k]);
    a.distance.push_back(static_cast<double>(k) * layers.spacing);
  }
  return a;
}

/// The grain nearest to a point, and those within half a mean diameter of the line from it along the axis.
Array line_array(const State& state, int axis, const Vec3& point) {
  const auto& g = state.grains;
  double nearest = INFINITY, mean = 0;
  Index source = 0;
  for (std::size_t i = 0; i < g.size(); ++i) {
    mean += g.radius(i) / static_cast<double>(g.size());
    const double far = norm(g.position[i].vec() - point);
    if (far < nearest) nearest = far, source = static_cast<Index>(i);
  }
  const Vec3 at = g.position[source].vec();
  std::vector<std::pair<double, Index>> line;
  for (std::size_t i = 0; i < g.size(); ++i) {
    const Vec3 away = g.position[i].vec() - at;
    Vec3 beside = away;
    beside[axis] = 0;
    if (away[axis] >= 0 && norm(beside) <= mean) line.emplace_back(norm(away), static_cast<Index>(i));
  }
  std::ranges::sort(line);
  if (line.size() < 4) throw InputError("--point: fewer than four grains are in line with it along the axis; move it");
  Array a;
  a.source = {source};
  for (const auto& [distance, grain] : line) a.receivers.push_back({grain}), a.distance.push_back(distance);
  return a;
}

class Test {
 public:
  Test(const Scene& scene, const State& state, const TransmitSetup& setup, const Array& array)
      : setup_(setup), array_(array), state_(state), builds_(state.list.builds) {
    for (auto& v : state_.grains.velocity) v.set({});
    for (auto& w : state_.grains.spin) w.set({});
    for (const Index i : array.source) {
      state_.grains.velocity[i].w = 0;
      if (state_.grains.rotates()) state_.grains.spin[i].w = 0;
    }
    state_.cell.rate = {}, state_.dt = setup.dt;
    for (auto& body : state_.bodies) body.velocity = {}, body.opening = 0;
    for (const auto& q : state_.grains.position) start_.push_back(q.vec()[setup.motion]);
    scene_ = scene;
    scene_.damping = {.normal_ratio = setup.damping, .shear_ratio = setup.damping};
    scene_.energy = false;
  }

  /// `size` times the signal; traces[k] gets the motion of receiver k.
  std::vector<std::vector<double>> run(double size, std::size_t steps, const std::function<void(double)>& progress) {
    Engine engine(scene_, state_);
    engine.set_local_damping(0);
    std::vector<std::vector<double>> traces(array_.receivers.size());
    record(traces);
    for (std::size_t k = 0; k < steps; ++k) {
      const double t = static_cast<double>(k) * setup_.dt;
      Vec3 velocity;
      velocity[setup_.motion] = size * (setup_.signal(t + setup_.dt) - setup_.signal(t)) / setup_.dt;
      for (const Index i : array_.source) state_.grains.velocity[i].set(velocity);
      engine.step(setup_.dt, TallyLevel::none);
      if ((k + 1) % static_cast<std::size_t>(setup_.every) == 0) record(traces);
      if (progress && k % 64 == 0) progress(static_cast<double>(k) / static_cast<double>(steps));
    }
    if (state_.list.builds != builds_)
      throw RunError("the grains moved too far for a test of small waves; use a packing at rest, a smaller amplitude");
    return traces;
  }

  double sliding() const {
    std::size_t contacts = 0, slide = 0;
    visit_contacts(scene_, state_, [&](const ContactPoint& p) { ++contacts, slide += p.limit > 0 && p.sliding(); });
    return contacts == 0 ? 0 : static_cast<double>(slide) / static_cast<double>(contacts);
  }

 private:
  void record(std::vector<std::vector<double>>& traces) const {
    for (std::size_t k = 0; k < traces.size(); ++k) {
      double sum = 0;
      for (const Index i : array_.receivers[k]) sum += state_.grains.position[i].vec()[setup_.motion] - start_[i];
      traces[k].push_back(sum / static_cast<double>(array_.receivers[k].size()));
    }
  }

  const TransmitSetup& setup_;
  const Array& array_;
  Scene scene_;
  State state_;
  std::uint64_t builds_;
  std::vector<double> start_;
};

/// Largest net force over the mean contact force that still counts as rest.
constexpr double at_rest = 1e-7;

double unbalanced(const Scene& scene, State state) {
  Engine engine(scene, state);
  for (auto& v : state.grains.velocity) v.set({});
  for (auto& w : state.grains.spin) w.set({});
  state.cell.rate = {}, state.dt = 0;
  engine.step(0, TallyLevel::works);
  return engine.unbalanced_ratio();
}

}  // namespace

Layers find_layers(const State& state, int axis) {
  const auto& g = state.grains;
  std::vector<std::pair<double, Index>> at;
  double diameter = 0;
  for (std::size_t i = 0; i < g.size(); ++i) {
    at.emplace_back(g.position[i].vec()[axis], static_cast<Index>(i));
    diameter += 2 * g.radius(i) / static_cast<double>(g.size());
  }
  std::ranges::sort(at);
  Layers planes;
  double first = at.front().first;
  bool crystal = true;
  for (const auto& [x, i] : at) {
    if (planes.grains.empty() || x - first > 0.02 * diameter) planes.grains.emplace_back(), first = x;
    crystal = crystal && x - first <= 1e-3 * diameter;
    planes.grains.back().push_back(i);
  }
  const auto count = planes.grains.size();
  if (crystal && count > 1) {
    planes.spacing = (at.back().first - at.front().first) / static_cast<double>(count - 1);
    if (planes.spacing > 0.1 * diameter) return planes;
  }
  const bool periodic = state.cell.periodic[static_cast<std::size_t>(axis)];
  const double low = periodic ? state.cell.origin[axis] : at.front().first;
  const double length = periodic ? state.cell.width(axis) : at.back().first - low;
  const auto slices = static_cast<std::size_t>(std::max(1.0, std::floor(length / diameter)));
  Layers out{std::vector<std::vector<Index>>(slices), length / static_cast<double>(slices)};
  for (const auto& [x, i] : at) {
    const double share = (x - low) / length;
    const auto k = static_cast<std::size_t>(
        std::clamp((share - std::floor(share)) * static_cast<double>(slices), 0.0, static_cast<double>(slices) - 1));
    out.grains[k].push_back(i);
  }
  return out;
}

Transmission transmit(const Scene& scene, const State& state, const TransmitSetup& setup) {
  if (state.contacts.tail_vectors > 0)
    throw InputError("the packing keeps energies of contact dashpots; make it with record.energy = false");
  const Array array = setup.point ? line_array(state, setup.axis, *setup.point) : layer_array(state, setup.axis);
  Transmission out;
  out.steps = static_cast<std::size_t>(std::ceil(setup.duration / setup.dt));
  out.interval = setup.dt * setup.every, out.spacing = array.spacing;
  out.subtracted = unbalanced(scene, state) > at_rest;
  const double share = out.subtracted ? 0.5 : 1.0;
  const auto report = [&](double from) {
    return [&, from](double done) { setup.progress ? setup.progress(from + share * done) : void(); };
  };
  Test test(scene, state, setup, array);
  auto moved = test.run(setup.amplitude, out.steps, report(0));
  out.sliding = test.sliding();
  if (out.subtracted) {
    const auto still = Test(scene, state, setup, array).run(0, out.steps, report(0.5));
    for (std::size_t k = 0; k < moved.size(); ++k)
      for (std::size_t s = 0; s < moved[k].size(); ++s) moved[k][s] -= still[k][s];
  }
  for (std::size_t k = 0; k < moved.size(); ++k)
    out.traces.push_back({array.distance[k], array.receivers[k].size(), std::move(moved[k])});
  return out;
}

}  // namespace eg
