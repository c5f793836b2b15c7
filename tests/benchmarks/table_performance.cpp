// The whole explicit step, list upkeep included, against LAMMPS on the same packings in the same run: a slow isotropic
// compression of Hertz–Mindlin spheres with shear history, one core each, run in turn.
// Run by: ./dev bench performance [GRAINS...]; needs Debian's package lammps for the comparison.
#include "rivals.hpp"
#include "support/packings.hpp"
#include "support/program.hpp"

using namespace eg;
using namespace eg::bench;

namespace {

constexpr int rounds = 5;

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
  const double begin = omp_get_wtime();
  for (std::size_t k = 1; k < c.steps; ++k) engine.step(c.dt, TallyLevel::none);
  const double spent = omp_get_wtime() - begin;
  engine.step(c.dt);
  touching = engine.tally().touching;
  return 1e9 * spent / static_cast<double>(c.steps - 1) / touching;
}

std::string lammps_setup(const Case& c) {
  const Material& m = c.scene.materials.front();
  return fmt::format(
      "neighbor 1e-4 bin\npair_style gran/hertz/history {:.17g} {:.17g} 0 NULL {} 1\npair_coeff * *\ntimestep {}\n"
      "fix 1 all nve/sphere\nfix 2 all deform 1 x erate {} y erate {} z erate {} remap x\nrun 10\nrun {}\n",
      4 * m.shear_modulus / (3 * (1 - m.poisson)), 4 * m.shear_modulus / (2 - m.poisson), m.friction, c.dt, -c.rate,
      -c.rate, -c.rate, c.steps);
}

void print_row(std::size_t grains) {
  const Case c = compression(grains);
  const Lammps rival(c.state, c.scene.materials.front().density, "p p p", lammps_setup(c));
  double touching = 0;
  Spread one, two, lammps, ratio;
  for (int k = 0; k < rounds; ++k) {
    pin(true);
    one.values.push_back(our_time(c, 1, touching));
    const double seconds = rival.seconds();
    if (seconds > 0) {
      lammps.values.push_back(1e9 * seconds / static_cast<double>(c.steps) / touching);
      ratio.values.push_back(lammps.values.back() / one.values.back());
    }
    pin(false);
    two.values.push_back(our_time(c, 2, touching));
  }
  fmt::print("{:>8} {:>9.0f} {:>22} {:>22} {:>22} {:>20}\n", grains, touching, one.text(), two.text(), lammps.text(),
             ratio.text());
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"The whole step against LAMMPS on the same packings", "table_performance"};
  std::vector<std::size_t> sizes = {10000, 100000, 1000000};
  app.add_option("grains", sizes, "numbers of grains")->check(test::grain_counts);
  return test::run_program(app, argc, argv, [&] {
    fmt::print("ns a step and touching contact: median (least–most) of {} rounds\n", rounds);
    fmt::print("{:>8} {:>9} {:>22} {:>22} {:>22} {:>20}\n", "grains", "contacts", "one core", "two cores",
               "LAMMPS, one core", "ratio, one core");
    for (const auto n : sizes) print_row(n);
    return 0;
  });
}
