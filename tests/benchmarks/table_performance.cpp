// The whole explicit step, list upkeep included, against LAMMPS on the same packings in the same run: a slow isotropic
// compression of Hertz–Mindlin spheres with shear history, one core each, run in turn.
// Run by: ./dev bench performance [GRAINS...]; needs Debian's package lammps for the comparison.
#include <fmt/format.h>
#include <omp.h>
#include <sched.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "support/packings.hpp"

using namespace eg;

namespace {

constexpr int rounds = 5;

struct Spread {
  std::vector<double> values;
  double at(double share) {
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
  }
  std::string text() {
    return values.empty() ? std::string("-") : fmt::format("{:.2f} ({:.2f}–{:.2f})", at(0.5), at(0), at(1));
  }
};

double now() { return omp_get_wtime(); }

/// This process, and what it starts, on the first core only; or on all again.
void pin(bool one) {
  static cpu_set_t all = [] {
    cpu_set_t s;
    sched_getaffinity(0, sizeof s, &s);
    return s;
  }();
  cpu_set_t set = all;
  if (one) {
    int first = 0;
    while (!CPU_ISSET(first, &all)) ++first;
    CPU_ZERO(&set);
    CPU_SET(first, &set);
  }
  sched_setaffinity(0, sizeof set, &set);
}

struct Case {
  Scene scene = test::scene_of("hertz-mindlin");
  State state;
  double dt, rate;
  std::size_t steps;
};

Case compression(std::size_t grains) {
  Case c;
  c.state = test::random_packing(c.scene, "uniform", grains);
  for (auto& v : c.state.grains.velocity) v = {0, 0, 0, v.w};
  for (auto& w : c.state.grains.spin) w = {0, 0, 0, w.w};
  c.dt = 0.1 / std::sqrt(splitting_bound(linearise(c.scene, c.state)).value);
  c.rate = 1e-7 / c.dt;  // 1e-5 of strain in a hundred steps
  c.steps = std::max<std::size_t>(30, 5'000'000 / grains);
  return c;
}

/// Wall time a step and touching contact [ns]; sets their number.
double our_time(const Case& c, int threads, double& touching) {
  omp_set_num_threads(threads);
  State state = c.state;
  for (int k = 0; k < 3; ++k) state.cell.rate(k, k) = -c.rate;
  Engine engine(c.scene, state);
  engine.step(c.dt);
  const double begin = now();
  for (std::size_t k = 1; k < c.steps; ++k) engine.step(c.dt, TallyLevel::none);
  const double spent = now() - begin;
  engine.step(c.dt);
  touching = engine.tally().touching;
  return 1e9 * spent / static_cast<double>(c.steps - 1) / touching;
}

void write_lammps(const Case& c, const std::string& folder) {
  const State& s = c.state;
  std::ofstream data(folder + "/packing.data");
  data << "packing\n\n" << s.grains.size() << " atoms\n1 atom types\n\n";
  for (int k = 0; k < 3; ++k) data << fmt::format("0 {:.17g} {}lo {}hi\n", s.cell.h(k, k), "xyz"[k], "xyz"[k]);
  data << "\nAtoms # sphere\n\n";
  for (std::size_t i = 0; i < s.grains.size(); ++i) {
    Vec3 x = s.grains.position[i].vec();
    for (int k = 0; k < 3; ++k) x[k] -= s.cell.h(k, k) * std::floor(x[k] / s.cell.h(k, k));
    data << fmt::format("{} 1 {:.17g} 2650 {:.17g} {:.17g} {:.17g}\n", i + 1, 2 * s.grains.radius(i), x.x, x.y, x.z);
  }
  const Material& m = c.scene.materials.front();
  std::ofstream(folder + "/in.step") << fmt::format(
      "units si\natom_style sphere\nboundary p p p\nnewton off\ncomm_modify vel yes\nread_data {}/packing.data\n"
      "neighbor {} bin\nneigh_modify delay 0 every 1 check yes\n"
      "pair_style gran/hertz/history {:.17g} {:.17g} 0 NULL {} 1\npair_coeff * *\ntimestep {}\n"
      "fix 1 all nve/sphere\nfix 2 all deform 1 x erate {} y erate {} z erate {} remap x\nthermo 1000000\n"
      "run 10\nrun {}\n",
      folder, 1e-4, 4 * m.shear_modulus / (3 * (1 - m.poisson)), 4 * m.shear_modulus / (2 - m.poisson), m.friction,
      c.dt, -c.rate, -c.rate, -c.rate, c.steps);
}

/// Loop time that LAMMPS reports [s]; negative when it does not run.
double lammps_seconds(const std::string& folder) {
  FILE* pipe = popen(("OMP_NUM_THREADS=1 lmp -in " + folder + "/in.step -log none 2>/dev/null").c_str(), "r");
  if (!pipe) return -1;
  double seconds = -1;
  for (char line[512]; std::fgets(line, sizeof line, pipe);) std::sscanf(line, "Loop time of %lf", &seconds);
  pclose(pipe);
  return seconds;
}

void print_row(std::size_t grains) {
  const Case c = compression(grains);
  double touching = 0;
  const auto folder = std::filesystem::temp_directory_path() / fmt::format("eigengrain_performance_{}", getpid());
  std::filesystem::create_directories(folder);
  write_lammps(c, folder.string());
  Spread one, two, lammps, ratio;
  for (int k = 0; k < rounds; ++k) {
    pin(true);
    one.values.push_back(our_time(c, 1, touching));
    const double seconds = lammps_seconds(folder.string());
    if (seconds > 0) {
      lammps.values.push_back(1e9 * seconds / static_cast<double>(c.steps) / touching);
      ratio.values.push_back(lammps.values.back() / one.values.back());
    }
    pin(false);
    two.values.push_back(our_time(c, 2, touching));
  }
  std::filesystem::remove_all(folder);
  fmt::print("{:>8} {:>9.0f} {:>22} {:>22} {:>22} {:>20}\n", grains, touching, one.text(), two.text(), lammps.text(),
             ratio.text());
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::size_t> sizes;
  for (int k = 1; k < argc; ++k) sizes.push_back(static_cast<std::size_t>(std::atof(argv[k])));
  if (sizes.empty()) sizes = {10000, 100000, 1000000};
  fmt::print("ns a step and touching contact: median (least–most) of {} rounds\n", rounds);
  fmt::print("{:>8} {:>9} {:>22} {:>22} {:>22} {:>20}\n", "grains", "contacts", "one core", "two cores",
             "LAMMPS, one core", "ratio, one core");
  for (const auto n : sizes) print_row(n);
}
