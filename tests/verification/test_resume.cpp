// A run that was stopped, written, read and resumed equals the unbroken one bit for bit, whatever the number of
// threads.
#include <gtest/gtest.h>
#include <omp.h>

#include <filesystem>

#include "dynamics/run.hpp"
#include "io/scene_file.hpp"
#include "io/snapshot.hpp"
#include "support/scene_text.hpp"
#include "support/scenes.hpp"
#include "timestep/controller.hpp"

using namespace eg;

namespace {

const std::string text = "title = \"resume\"\ndimension = 3\nseed = 3\n" + test::quartz + R"([contact]
law = "hertz-mindlin-rescale"
[specimen]
source = "cloud"
count = 1100
grading = { radius = 1e-4 }
solid_fraction = 0.55
[boundary]
type = "periodic"
[damping]
local = 0.3
normal_ratio = 0.02
shear_ratio = 0.02
[record]
energy = true
[[stage]]
name = "compress"
friction = 0.05
stress = { isotropic = 50e3 }
max_strain_rate = 500
until = { steps = 700 }
[[stage]]
name = "shear"
strain_rate = { z = 60 }
hold = { mean_stress = 50e3, equal = ["x", "y"] }
until = { steps = 700 }
)";

/// Goes on until the given step (or the end), then through a file.
State go_on(const Scene& scene, State state, std::uint64_t until) {
  Controller controller(scene);
  RunObserver observer;
  std::uint64_t now = state.step;
  observer.step = [&](const State& s, const RunStatus&) { now = s.step; };
  observer.stop = [&] { return now >= until; };
  run_stages(scene, state, controller, observer);
  const auto path =
      std::filesystem::temp_directory_path() / ("eigengrain_resume_" + std::to_string(::getpid()) + ".h5");
  write_snapshot(path.string(), scene, state);
  State back = read_snapshot(path.string()).state;
  std::filesystem::remove(path);
  return back;
}

void expect_equal(const State& a, const State& b) {
  ASSERT_EQ(a.step, b.step);
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.cell.h.a, b.cell.h.a);
  EXPECT_EQ(a.virial.a, b.virial.a);
  EXPECT_EQ(a.ledger.friction, b.ledger.friction);
  EXPECT_EQ(a.ledger.viscous_damping, b.ledger.viscous_damping);
  EXPECT_EQ(a.list.builds, b.list.builds);
  for (std::size_t i = 0; i < a.grains.size(); ++i) {
    ASSERT_EQ(a.grains.id[i], b.grains.id[i]);
    ASSERT_EQ(a.grains.position[i].x, b.grains.position[i].x);
    ASSERT_EQ(a.grains.velocity[i].z, b.grains.velocity[i].z);
    ASSERT_EQ(a.grains.spin[i].y, b.grains.spin[i].y);
  }
  EXPECT_EQ(a.contacts.history, b.contacts.history);
}

TEST(Resume, EqualsTheUnbrokenRunBitForBit) {
  const Scene scene = parse_scene(text, "resume.toml");
  omp_set_num_threads(1);
  const State start = test::state_of(scene);
  const State unbroken = go_on(scene, start, ~std::uint64_t{0});
  ASSERT_EQ(unbroken.step, 1400u);
  ASSERT_GT(unbroken.virial(0, 0), 0);
  for (const std::uint64_t stop : {1ul, 377ul, 700ul, 1100ul}) {
    omp_set_num_threads(stop % 2 == 0 ? 2 : 1);
    expect_equal(go_on(scene, go_on(scene, start, stop), ~std::uint64_t{0}), unbroken);
  }
}

}  // namespace
