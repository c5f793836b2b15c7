// Cost of the elastic tensor against the number of grains: ./dev bench stiffness [TOLERANCE [GRAINS…]]. Packings above
// 150,000 grains are eight of an eighth of the size side by side, each contact with 10 % more or less stiffness at
// random, so that no cell is a copy.
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <string>

#include "app/number_words.hpp"
#include "report/table.hpp"
#include "stiffness/backbone.hpp"
#include "stiffness/relaxation.hpp"
#include "support/packings.hpp"
#include "support/program.hpp"
#include "support/tiling.hpp"

namespace {

using namespace eg;

/// Largest resident memory of this process so far [MB].
double peak_memory() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (word == "VmHWM:") {
      double kilobytes = 0;
      status >> kilobytes;
      return kilobytes / 1024;
    }
  return 0;
}

struct Sample {
  Network network;
  double volume;
};

Sample sample(std::size_t grains) {
  const Scene scene = test::scene_of("hertz-mindlin");
  const int copies = grains > 150000 ? 2 : 1;
  const auto cube = static_cast<std::size_t>(copies * copies * copies);
  State state = test::random_packing(scene, "uniform", grains / cube, 1, 0.64, 60);
  if (copies > 1) {
    state = test::tiled(scene, state, copies);
    const Engine lists(scene, state);
  }
  Sample big{linearise(scene, state), state.cell.volume()};
  Random random(9);
  for (Spring& s : big.network.springs) {
    if (copies == 1) break;
    const double change = random.uniform(0.9, 1.1);
    s.normal *= change, s.tangential *= change;
  }
  return big;
}

int print_table(double tolerance, const std::vector<std::size_t>& sizes) {
  Table table({{"grains"},
               {"contacts"},
               {"iterations", "iterations of six loads"},
               {"time", "", "s", 3},
               {"growth", "d ln time/d ln grains", "-", 3},
               {"error", "", "-", 2},
               {"memory", "peak memory", "MB"}});
  double time_before = 0, grains_before = 0;
  for (const std::size_t grains : sizes) {
    const Sample s = sample(grains);
    const auto begin = std::chrono::steady_clock::now();
    const Network network = backbone(s.network).network;
    const auto moduli =
        relax(network, periodic_strains(3), s.volume, {RelaxationOptions::Solver::conjugate_gradients, tolerance});
    const double time = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const auto size = static_cast<double>(network.size());
    const double growth = time_before > 0 ? std::log(time / time_before) / std::log(size / grains_before) : NAN;
    time_before = time, grains_before = size;
    table.add({static_cast<std::int64_t>(network.size()), static_cast<std::int64_t>(network.springs.size()),
               static_cast<std::int64_t>(moduli.iterations), time, growth, moduli.error, peak_memory()});
    fmt::print(stderr, "{} grains: {:.2f} s\n", network.size(), time);
  }
  fmt::print("{}", table.text());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Cost of the elastic tensor by size of packing", "table_stiffness"};
  double tolerance = 1e-10;
  std::vector<std::size_t> sizes = {1000, 10000, 100000};
  app.add_option("tolerance", tolerance, "largest relative error")->check(positive_option)->capture_default_str();
  app.add_option("grains", sizes, "numbers of grains")->check(test::grain_counts);
  return test::run_program(app, argc, argv, [&] { return print_table(tolerance, sizes); });
}
