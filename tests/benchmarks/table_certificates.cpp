// Width and cost of the proved time step: packings of several kinds and sizes, cost in explicit steps of the same
// packing with the same threads. Run by: ./dev bench certificates [GRAINS...]
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <vector>

#include "support/packings.hpp"
#include "support/program.hpp"
#include "timestep/interval.hpp"

using namespace eg;

namespace {

double seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// The shortest of a few runs: other programs share the machine.
template <class Work>
double time_of(int runs, Work work) {
  double best = INFINITY;
  for (int k = 0; k < runs; ++k) {
    const double begin = seconds();
    work();
    best = std::min(best, seconds() - begin);
  }
  return best;
}

void print_row(const char* kind, const Scene& scene, State& state) {
  Engine engine(scene, state);
  const double step = time_of(10, [&] { engine.step(1e-15); });
  Network network;
  StepInterval interval;
  SplittingBound splitting;
  const double assembly = time_of(3, [&] { network = linearise(scene, state); });
  const double cheap =
      time_of(3, [&] { splitting = splitting_bound(network, {.scalar_sweeps = 8, .matrix_sweeps = 0}); });
  const double whole = time_of(3, [&] { interval = step_interval(network, {.dense_limit = 0}); });
  const std::string probable =
      interval.probable_error > 0 ? fmt::format("{:.1e}", interval.lambda_probable / interval.lambda_lower - 1) : "-";
  fmt::print("{:<18} {:>8} {:>9} {:>9.3f} {:>9.1f} {:>9.1e} {:>9.1f} {:>9.1e} {:>9}  {}\n", kind, network.size(),
             network.springs.size(), 1e3 * step, (assembly + cheap) / step, splitting.value / interval.lambda_lower - 1,
             (assembly + whole) / step, interval.lambda_upper / interval.lambda_lower - 1, probable,
             interval.method_upper);
  std::fflush(stdout);
}

void print_lattice(const char* kind, const char* name, std::size_t grains, double scatter) {
  const bool flat = std::string(name) == "hexagonal";
  const double basis = flat ? 2 : 4;
  const int cells = static_cast<int>(std::round(flat ? std::sqrt(static_cast<double>(grains) / basis)
                                                     : std::cbrt(static_cast<double>(grains) / basis)));
  const Scene scene = test::lattice_scene(flat ? "linear" : "hertz-mindlin", name, {cells, cells, cells}, 0.01);
  State state = test::scattered_lattice(scene, scatter);
  print_row(kind, scene, state);
}

int print_table(const std::vector<std::size_t>& sizes) {
  fmt::print("{:<18} {:>8} {:>9} {:>9} | {:^19} | {:^29}\n", "", "", "", "one step", "in the run", "interval");
  fmt::print("{:<18} {:>8} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9}  {}\n", "packing", "grains", "contacts", "ms",
             "steps", "width", "steps", "width", "probable", "method of the upper end");
  for (const std::size_t grains : sizes) {
    for (const char* grading : {"uniform", "wide", "gap", "single"}) {
      if (grains > 200000 && std::string(grading) != "uniform") continue;
      const Scene scene = test::scene_of("hertz-mindlin");
      State state = test::random_packing(scene, grading, grains);
      print_row(grading, scene, state);
    }
    if (grains > 20000) continue;
    print_lattice("FCC", "fcc", grains, 0);
    print_lattice("FCC, 1 % scatter", "fcc", grains, 0.01);
    print_lattice("HCP, 1 % scatter", "hcp", grains, 0.01);
    print_lattice("hexagonal, 1 %", "hexagonal", grains, 0.01);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Cost and width of the proved time step, by kind and size of packing", "table_certificates"};
  std::vector<std::size_t> sizes = {1000, 10000, 100000};
  app.add_option("grains", sizes, "numbers of grains")->check(test::grain_counts);
  return test::run_program(app, argc, argv, [&] { return print_table(sizes); });
}
