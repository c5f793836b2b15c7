// Fast cases on one core: a cloud that settles under gravity in a box, a biaxial test of disks, and a flow down a
// rough-bottomed slope against LAMMPS; with the share of list upkeep. Run by: ./dev bench motion
#include <numbers>

#include "rivals.hpp"
#include "support/packings.hpp"
#include "support/program.hpp"

using namespace eg;
using namespace eg::bench;

namespace {

struct Measured {
  double rate, upkeep, per_contact;  ///< steps/s, share, ns
};

Measured run(const Scene& scene, State& state, double dt, int steps, double local = 0) {
  Engine engine(scene, state);
  engine.set_local_damping(local);
  engine.kick(dt);
  const double begin = omp_get_wtime(), upkeep = engine.upkeep();
  double touching = 0;
  for (int k = 1; k <= steps; ++k) {
    engine.step(dt, k % 10 ? TallyLevel::none : TallyLevel::works);
    if (k % 10 == 0) touching += 10 * engine.tally().touching;
  }
  const double spent = omp_get_wtime() - begin;
  return {steps / spent, (engine.upkeep() - upkeep) / spent, 1e9 * spent / touching};
}

void print_row(const std::string& name, const State& state, const Measured& m, Spread rival = {}) {
  fmt::print("{:<26} {:>7} {:>10.0f} {:>12.1f} {:>8.1f} % {:>20}", name, state.grains.size(), m.rate, m.per_contact,
             100 * m.upkeep, rival.text(0));
  if (!rival.values.empty()) fmt::print(" {:>6.2f}", m.rate / rival.at(0.5));
  fmt::print("\n");
  std::fflush(stdout);
}

void settling() {
  Scene scene = test::scene_of("hertz-mindlin");
  scene.materials.front().shear_modulus = 29e6;
  scene.gravity = {0, 0, -9.81};
  scene.materials.front().name = scene.boundary.wall_material = "quartz";
  scene.boundary.kind = BoundarySpec::Kind::box;
  scene.boundary.bodies = box_bodies(scene.dimension);
  scene.damping.normal_ratio = 0.2;
  Random random(1);
  State state = make_state(scene, make_cloud(test::radii_of("uniform", 10000, random), {3, 0.4}, random));
  print_row("settling in a box", state, run(scene, state, 4e-6, 4000));
}

void biaxial() {
  const Scene scene = test::scene_of("hertz-mindlin", 2);
  State state = test::random_packing(scene, "uniform", 5000, 1, 0.9);
  const double dt = 1 / std::sqrt(splitting_bound(linearise(scene, state)).value);
  state.cell.rate(1, 1) = -2e-6 / dt, state.cell.rate(0, 0) = 1.5e-6 / dt;  // a per cent of strain in the run
  print_row("biaxial test of disks", state, run(scene, state, dt, 5000, 0.1));
}

/// 32,000 spheres of unit size and mass, springs 2000 m g/d, on a plane inclined by 26° (Silbert et al. 2001).
void slope() {
  Scene scene = test::scene_of("linear");
  Material& m = scene.materials.front();
  m = test::linear_material(2000, 2.0 / 7 * 2000, 6 / std::numbers::pi, 0.5);
  m.name = "grain";
  scene.damping.normal_ratio = 25 / (2 * std::sqrt(0.5 * 2000));  // γn = 50 times the pair's mass
  scene.boundary.kind = BoundarySpec::Kind::free;
  const double angle = 26 * std::numbers::pi / 180;
  scene.gravity = {std::sin(angle), 0, -std::cos(angle)};
  WallSpec base;
  base.name = "base", base.normal = {0, 0, 1}, base.material = m.name;
  scene.boundary.bodies = {{.name = "base", .group = "", .velocity = {}, .material = ""}};
  scene.boundary.walls = {base};
  Random random(1);
  Packing packing = make_cloud(std::vector<double>(32000, 0.5), {3, 0.5, {40, 20, 42}}, random);
  State state = make_state(scene, packing);
  state.cell.h = Mat3{};
  for (int k = 0; k < 3; ++k) state.cell.h(k, k) = packing.box[k];
  state.cell.periodic = {true, true, false};
  const double dt = 1e-3;
  run(scene, state, dt, 5000, 0.3);
  const int steps = 1000;
  for (auto& v : state.grains.velocity) v = {0, 0, 0, v.w};
  for (auto& w : state.grains.spin) w = {0, 0, 0, w.w};
  const Lammps rival(state, m.density, "p p f",
                     fmt::format("neighbor 0.1 bin\npair_style gran/hooke/history 2000 NULL 50 NULL 0.5 0\n"
                                 "pair_coeff * *\ntimestep {}\nfix 1 all gravity 1.0 chute 26.0\nfix 2 all nve/sphere\n"
                                 "fix 3 all wall/gran hooke/history 2000 NULL 50 NULL 0.5 0 zplane 0.0 NULL\n"
                                 "run 10\nrun {}\n",
                                 dt, steps));
  Spread theirs;
  Measured ours{};
  for (int k = 0; k < 3; ++k) {
    State copy = state;
    copy.list = {}, copy.contacts = {}, copy.wall_contacts = {};
    const Measured now = run(scene, copy, dt, steps);
    if (now.rate > ours.rate) ours = now;
    if (const double seconds = rival.seconds(); seconds > 0) theirs.values.push_back(steps / seconds);
  }
  print_row("flow down a slope", state, ours, theirs);
}

int print_table() {
  pin(true);
  omp_set_num_threads(1);
  fmt::print("{:<26} {:>7} {:>10} {:>12} {:>10} {:>20} {:>6}\n", "case", "grains", "steps/s", "ns/contact", "lists",
             "LAMMPS steps/s", "ratio");
  settling();
  biaxial();
  slope();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Fast cases: steps a second, share of the lists, against LAMMPS", "table_motion"};
  return test::run_program(app, argc, argv, print_table);
}
