// Time of one explicit step for every contact law: 8,788 spheres, 52,728 contacts, all touching and all sheared.
#include <benchmark/benchmark.h>

#include "base/random.hpp"
#include "contact/laws.hpp"
#include "dynamics/engine.hpp"
#include "support/scenes.hpp"

namespace {

using namespace eg;

void step(benchmark::State& bench, const std::string& law) {
  const Scene scene = test::lattice_scene(law, "fcc", {13, 13, 13}, 1e-3);
  State state = test::state_of(scene);
  Random random(1);
  for (auto* set : {&state.grains.velocity, &state.grains.spin})
    for (auto& v : *set) {
      const double scale = set == &state.grains.spin ? 1 : 1e-3;  // [rad/s], [m/s]
      v.set(Vec3{random.normal(), random.normal(), random.normal()} * scale);
    }
  Engine engine(scene, state);
  if (law == "linear-parallel-bond") engine.bond({});
  const double dt = 1e-8;
  engine.kick(dt);
  engine.step(dt);
  const double contacts = engine.tally().touching;
  for (auto _ : bench) engine.step(dt, TallyLevel::stress);
  bench.counters["contacts"] = contacts;
  bench.counters["ns/contact"] =
      benchmark::Counter(contacts * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

const bool registered = [] {
  for (const auto& law : law_names())
    benchmark::RegisterBenchmark(("step/" + law).c_str(), [law](auto& bench) {
      step(bench, law);
    })->Unit(benchmark::kMicrosecond);
  return true;
}();

}  // namespace
