// What the control of the periodic cell promises: conditions on rates hold exactly, stresses meet their targets while
// the cell deforms, and a cell that has been sheared far is the same cell.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "boundary/cell_control.hpp"
#include "dynamics/run.hpp"
#include "io/scene_file.hpp"
#include "measure/stress.hpp"
#include "measure/volume.hpp"
#include "support/scene_text.hpp"
#include "support/scenes.hpp"
#include "timestep/controller.hpp"

namespace eg {
namespace {

/// 300 spheres, compressed to 100 kPa and then put through `stages`.
std::string sand(const std::string& stages) {
  return "dimension = 3\nseed = 2\n" + test::quartz + R"([contact]
law = "hertz-mindlin"
[specimen]
source = "cloud"
count = 300
grading = { min_radius = 0.08e-3, max_radius = 0.12e-3 }
solid_fraction = 0.55
[boundary]
type = "periodic"
[damping]
local = 0.2
[[stage]]
name = "compress"
friction = 0.1
stress = { isotropic = 100e3 }
max_strain_rate = 100
until = { stress_error = 1e-3, unbalanced_force = 1e-3 }
)" + stages;
}

/// Runs it; `look` sees every step of all stages but the first.
State run(const std::string& text, const std::function<void(const State&)>& look) {
  const Scene scene = parse_scene(text);
  State state = test::state_of(scene);
  Controller controller(scene);
  RunObserver observer;
  observer.step = [&](const State& s, const RunStatus&) {
    if (s.stage > 0) look(s);
  };
  run_stages(scene, state, controller, observer);
  return state;
}

struct Track {
  double worst = 0, sum = 0;
  std::size_t count = 0;
  void add(double relative) { worst = std::max(worst, std::abs(relative)), sum += relative, ++count; }
  double mean() const { return sum / static_cast<double>(count); }
};

TEST(CellControl, ConstantMeanStressAndInertialNumberAsItDeforms) {
  Track p, inertia;
  double d50 = 0;
  run(sand(R"([[stage]]
name = "shear"
strain_rate = { axis = "z", inertial_number = 2e-3 }
hold = { mean_stress = 100e3, b = 0 }
until = { axial_strain = 0.02 })"),
      [&](const State& s) {
        if (d50 == 0) d50 = size_statistics(s).d50;
        p.add(mean_stress(s) / 100e3 - 1);
        inertia.add(inertial_number(s.cell.rate(2, 2), d50, 2650, mean_stress(s)) / 2e-3 - 1);
      });
  EXPECT_LT(std::abs(p.mean()), 1e-3);
  EXPECT_LT(p.worst, 5e-3);
  EXPECT_LT(inertia.worst, 1e-12);
}

TEST(CellControl, UndrainedKeepsTheVolume) {
  double volume = 0, worst = 0, uneven = 0;
  run(sand(R"([[stage]]
name = "shear"
strain_rate = { z = 40 }
hold = { volume_rate = 0, equal = ["x", "y"] }
until = { axial_strain = 0.03 })"),
      [&](const State& s) {
        if (volume == 0) volume = s.cell.volume();
        worst = std::max(worst, std::abs(s.cell.volume() / volume - 1));
        const auto e = stage_strain(s);
        uneven = std::max(uneven, std::abs(e[0] - e[1]));
      });
  EXPECT_LT(worst, 1e-13);
  EXPECT_EQ(uneven, 0);
}

TEST(CellControl, K0KeepsTheSides) {
  double x = 0;
  run(sand("[[stage]]\nname = \"press\"\nstress = { z = 200e3 }\nmax_strain_rate = 20\n"
           "until = { stress_error = 5e-4, unbalanced_force = 1e-3 }"),
      [&](const State& s) {
        if (x == 0) x = s.cell.h(0, 0);
        ASSERT_EQ(s.cell.h(0, 0), x);
        ASSERT_EQ(stage_strain(s)[1], 0);
      });
}

TEST(CellControl, DrainedTargetsWithoutOffset) {
  Track x, y;
  run(sand("[[stage]]\nname = \"shear\"\nstrain_rate = { z = 10 }\nstress = { x = 100e3, y = 100e3 }\n"
           "until = { axial_strain = 0.01 }"),
      [&](const State& s) {
        const auto stress = stress_components(s);
        x.add(stress[0] / 100e3 - 1), y.add(stress[1] / 100e3 - 1);
      });
  EXPECT_LT(std::abs(x.mean()), 5e-4);
  EXPECT_LT(std::abs(y.mean()), 5e-4);
}

TEST(CellControl, ConditionsOnStressesHold) {
  Track q, b;
  run(sand(R"([[stage]]
name = "load"
strain_rate = { z = 5 }
hold = { mean_stress = 100e3, b = 0.4 }
until = { axial_strain = 0.003 }
[[stage]]
name = "dilate"
hold = { deviator = 30e3, volume_rate = -2, equal = ["x", "y"] }
until = { time = 1e-4 })"),
      [&](const State& s) {
        const auto stress = stress_components(s);
        if (s.stage == 1 && s.stage_time > 5e-4) b.add((stress[1] - stress[0]) / (stress[2] - stress[0]) - 0.4);
        if (s.stage == 2 && s.stage_time > 2e-5) q.add((stress[2] - (stress[0] + stress[1]) / 2) / 30e3 - 1);
      });
  ASSERT_GT(b.count, 100u);
  ASSERT_GT(q.count, 100u);
  EXPECT_LT(std::abs(b.mean()), 2e-3);
  EXPECT_LT(std::abs(q.mean()), 5e-3);
}

TEST(CellControl, CyclesTurnAtTheirLimitsAndAreCounted) {
  double high = -1e9, low = 1e9;
  const State end = run(sand(R"([[stage]]
name = "cyclic"
strain_rate = { z = 10 }
hold = { volume_rate = 0, equal = ["x", "y"] }
cycle = { stress = "deviator", mean = 5e3, amplitude = 10e3 }
until = { cycles = 3 })"),
                        [&](const State& s) {
                          if (s.stage != 1) return;
                          const auto stress = stress_components(s);
                          const double q = stress[2] - (stress[0] + stress[1]) / 2;
                          high = std::max(high, q), low = std::min(low, q);
                        });
  EXPECT_EQ(end.cycle.turns, 6u);
  EXPECT_NEAR(high, 15e3, 1e3);
  EXPECT_NEAR(low, -5e3, 1e3);
}

TEST(Cell, SlowRatesMoveItExactly) {
  Cell cell;
  cell.h(0, 0) = 1e-3, cell.h(1, 1) = 2e-3, cell.h(2, 2) = 3e-3;
  cell.rate(2, 2) = -1e-7, cell.rate(0, 2) = 1e-7;
  const double dt = 1.3e-7;
  const int steps = 200000;
  for (int k = 0; k < steps; ++k) cell.deform(dt);
  const double strain = 1e-7 * dt * steps;  // 2.6e-9: an increment is a hundredth of round-off of the edge
  EXPECT_NEAR(-cell.strain(2, 2) / strain, 1, 1e-12);
  EXPECT_NEAR((1 - cell.h(2, 2) / 3e-3) / strain, 1, 1e-7);
  EXPECT_NEAR(cell.h(0, 2) / 3e-3 / strain, 1, 1e-7);
}

TEST(Cell, DeformsByTheExponential) {
  Cell cell;
  cell.rate(0, 0) = -3, cell.rate(1, 1) = 2, cell.rate(2, 2) = 1, cell.rate(0, 2) = 4, cell.rate(0, 1) = -1;
  for (int k = 0; k < 1000; ++k) cell.deform(1e-3);
  EXPECT_NEAR(cell.volume(), 1, 1e-14);
  EXPECT_NEAR(cell.h(0, 0), std::exp(-3.), 1e-14);
  EXPECT_NEAR(cell.h(0, 2), 4 * (std::exp(1.) - std::exp(-3.)) / 4, 1e-13);  // ∫ exp(−3(1−t)) 4 exp(t) dt
}

TEST(Cell, StraightenedIsTheSameLattice) {
  Cell cell;
  cell.h(0, 0) = 2, cell.h(1, 1) = 3, cell.h(2, 2) = 5;
  cell.h(0, 1) = 1.7, cell.h(0, 2) = -7.3, cell.h(1, 2) = 4.6;
  const Cell leaning = cell;
  const auto n = cell.straighten();
  EXPECT_LE(std::abs(cell.h(0, 1)), 1);
  EXPECT_LE(std::abs(cell.h(0, 2)), 1);
  EXPECT_LE(std::abs(cell.h(1, 2)), 1.5);
  for (const std::array<int, 3> steps : {std::array{1, 0, 0}, std::array{-1, 1, 0}, std::array{1, -1, 1}}) {
    const auto now = Cell::renamed(steps, n);
    const auto at = [](const Mat3& h, const std::array<int, 3>& s) {
      return h * Vec3{double(s[0]), double(s[1]), double(s[2])};
    };
    EXPECT_LT(norm(at(cell.h, now) - at(leaning.h, steps)), 1e-14);
  }
}

/// A shearing cell whose faces are renamed gives the forces of one that leans further and further.
TEST(CellControl, LargeSimpleShearLosesNoContact) {
  double before = 0, worst = 0, leaning = 0;
  std::size_t renamed = 0;
  run(sand(R"([[stage]]
name = "shear"
strain_rate = { xz = 400 }
stress = { z = 100e3 }
until = { shear_strain = 0.8 })"),
      [&](const State& s) {
        const double lean = s.cell.h(0, 2) / s.cell.h(0, 0), tau = stress_components(s)[4];
        if (std::abs(lean - leaning) > 0.5) ++renamed, worst = std::max(worst, std::abs(tau - before));
        EXPECT_LT(std::abs(lean), 0.65);
        leaning = lean, before = tau;
      });
  EXPECT_GE(renamed, 1u);
  EXPECT_LT(worst, 3e3);  // as from any step to the next: a lost contact changes some 10 kPa
}

}  // namespace
}  // namespace eg
