// Parts of the explicit step and of K·x on a packing of 10,000 grains: time a contact (or a grain) and run.
#include <benchmark/benchmark.h>

#include "assembly/apply.hpp"
#include "contact/laws.hpp"
#include "search/grid.hpp"
#include "search/neighbours.hpp"
#include "support/packings.hpp"

using namespace eg;

namespace {

constexpr std::size_t grains = 10000;
constexpr double still = 1e-13;  // [s]: the packing stays as it is

/// Whole steps; counts contacts that touch.
void step(benchmark::State& bench, const Scene& scene) {
  State state = test::random_packing(scene, "uniform", grains, 1, scene.dimension == 3 ? 0.66 : 0.9);
  Engine engine(scene, state);
  engine.step(still);
  const double touching = engine.tally().touching;
  for (auto _ : bench) engine.step(still, TallyLevel::none);
  bench.counters["per_contact"] =
      benchmark::Counter(touching, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void refresh(benchmark::State& bench) {
  const Scene scene = test::scene_of("hertz-mindlin");
  State state = test::random_packing(scene, "uniform", grains);
  for (auto _ : bench) refresh_contacts(state);
}

void rebuild(benchmark::State& bench) {
  const Scene scene = test::scene_of("hertz-mindlin");
  State state = test::random_packing(scene, "uniform", grains);
  for (auto _ : bench) rebuild_neighbours(state, state.list.skin, state.list.contact_skin);
}

void stiffness_product(benchmark::State& bench) {
  const Scene scene = test::scene_of("hertz-mindlin");
  const State state = test::random_packing(scene, "uniform", static_cast<std::size_t>(bench.range(0)));
  const Network net = linearise(scene, state);
  const StiffnessOperator k(net, StiffnessOperator::Scaling::mass);
  std::vector<double> x(k.rows(), 1.0), y(k.rows());
  for (auto _ : bench) k.apply(x, y);
  bench.counters["per_contact"] =
      benchmark::Counter(static_cast<double>(net.springs.size()),
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// a = b + s·c over arrays of 80 MB each: what memory gives.
void triad(benchmark::State& bench) {
  const std::size_t n = 10'000'000;
  AlignedVector<double> a(n), b(n, 1.0), c(n, 2.0);
  for (auto _ : bench) {
    for (std::size_t k = 0; k < n; ++k) a[k] = b[k] + 3.0 * c[k];
    benchmark::ClobberMemory();
  }
  bench.SetBytesProcessed(static_cast<std::int64_t>(bench.iterations()) * 24 * static_cast<std::int64_t>(n));
}

void flat_step(benchmark::State& bench) { step(bench, test::scene_of("hertz-mindlin", 2)); }
void frictionless_step(benchmark::State& bench) {
  Scene scene = test::scene_of("hertz-mindlin");
  scene.materials.front().friction = 0;
  scene.rotation = false;
  step(bench, scene);
}

}  // namespace

int main(int argc, char** argv) {
  for (const auto& law : law_names())
    benchmark::RegisterBenchmark(("step/" + law).c_str(), [law](benchmark::State& bench) {
      step(bench, test::scene_of(law));
    })->Unit(benchmark::kMicrosecond);
  benchmark::RegisterBenchmark("step/frictionless", frictionless_step)->Unit(benchmark::kMicrosecond);
  benchmark::RegisterBenchmark("step/disks", flat_step)->Unit(benchmark::kMicrosecond);
  benchmark::RegisterBenchmark("list/refresh", refresh)->Unit(benchmark::kMicrosecond);
  benchmark::RegisterBenchmark("list/rebuild", rebuild)->Unit(benchmark::kMicrosecond);
  benchmark::RegisterBenchmark("stiffness_product", stiffness_product)
      ->Arg(10000)
      ->Arg(100000)
      ->Unit(benchmark::kMicrosecond);
  benchmark::RegisterBenchmark("triad", triad)->Unit(benchmark::kMillisecond);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
}
