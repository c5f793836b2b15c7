// Cost of the elastic tensor against the number of grains: ./dev bench stiffness [TOLERANCE] [GRAINS...]
#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <string>

#include "report/table.hpp"
#include "stiffness/backbone.hpp"
#include "stiffness/relaxation.hpp"
#include "support/packings.hpp"

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

}  // namespace

int main(int count, char** arguments) {
  const double tolerance = count > 1 ? std::atof(arguments[1]) : 1e-10;
  std::vector<std::size_t> sizes;
  for (int k = 2; k < count; ++k) sizes.push_back(std::strtoul(arguments[k], nullptr, 10));
  if (sizes.empty()) sizes = {1000, 10000, 100000};
  Table table({{"grains"},
               {"contacts"},
               {"iterations", "iterations of six loads"},
               {"time", "", "s", 3},
               {"error", "", "-", 2},
               {"memory", "peak memory", "MB"}});
  const Scene scene = test::scene_of("hertz-mindlin");
  for (const std::size_t grains : sizes) {
    const State state = test::random_packing(scene, "uniform", grains, 1, 0.64, 60);
    const auto begin = std::chrono::steady_clock::now();
    const Network network = backbone(linearise(scene, state)).network;
    const auto moduli = relax(network, periodic_strains(3), state.cell.volume(),
                              {RelaxationOptions::Solver::conjugate_gradients, tolerance});
    const double time = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    table.add({static_cast<std::int64_t>(grains), static_cast<std::int64_t>(network.springs.size()),
               static_cast<std::int64_t>(moduli.iterations), time, moduli.error, peak_memory()});
    fmt::print(stderr, "{} grains: {:.2f} s\n", grains, time);
  }
  fmt::print("{}", table.text());
}
