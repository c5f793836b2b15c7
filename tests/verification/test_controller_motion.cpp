// policy = "certified" where much moves: after every single step the next one is held against the exact limit.
#include <gtest/gtest.h>

#include "base/random.hpp"
#include "dynamics/run.hpp"
#include "eigen/dense.hpp"
#include "support/controlled_run.hpp"
#include "support/packings.hpp"

namespace eg {
namespace {

/// How grains set out and what the cell does.
struct Motion {
  std::string name;
  double speed = 0, spin = 0;  ///< root mean square of a component [m/s], of the surface by spinning [m/s]
  std::string stage;           ///< its loading
};
std::ostream& operator<<(std::ostream& out, const Motion& m) { return out << m.name; }

/// Loose for odd seeds, pressed for even ones.
State thrown(const Scene& scene, const Motion& motion, std::uint64_t seed) {
  State state = test::random_packing(scene, "uniform", 48, seed, seed % 2 == 0 ? 0.66 : 0.58, 300);
  state.step = 0, state.time = 0;
  Random random(seed);
  const auto vector = [&](double size) { return Vec3{random.normal(), random.normal(), random.normal()} * size; };
  for (auto& v : state.grains.velocity) v.set(vector(motion.speed));
  for (std::size_t i = 0; i < state.grains.size(); ++i)
    state.grains.spin[i].set(vector(motion.spin / state.grains.radius(i)));
  return state;
}

/// λmax, worked out only where the bound does not settle that dt is below the limit.
double dt_over_limit(const Scene& scene, const State& state) {
  const Network net = linearise(scene, state);
  if (net.springs.empty()) return 0;
  const double least = std::sqrt(splitting_bound(net, {.scalar_sweeps = 4, .matrix_sweeps = 0}).value) * state.dt / 2;
  return least < 0.9 ? least : std::sqrt(dense_largest(dense_scaled_stiffness(net)).value) * state.dt / 2;
}

class ControllerIn : public ::testing::TestWithParam<Motion> {};

TEST_P(ControllerIn, NeverPassesTheLimit) {
  const Motion& motion = GetParam();
  double largest = 0, sum = 0;
  std::uint64_t steps = 0, outruns = 0, evaluations = 0, checks = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Scene scene = test::controlled_scene(48, motion.stage.c_str(), "local = 0");
    State state = thrown(scene, motion, seed);
    Controller controller(scene);
    RunObserver observer;
    observer.step = [&](const State& s, const RunStatus&) {
      const double ratio = dt_over_limit(scene, s);
      largest = std::max(largest, ratio), sum += ratio, ++steps;
    };
    run_stages(scene, state, controller, observer);
    outruns += controller.log().outruns, evaluations += controller.log().all_evaluations(),
        checks += controller.log().checks;
  }
  fmt::print("{}: dt over limit: mean {:.3f}, largest {:.4f}; {} evaluations, {} checks, {} outruns in {} steps\n",
             motion.name, sum / static_cast<double>(steps), largest, evaluations, checks, outruns, steps);
  EXPECT_LE(largest, 1);
  EXPECT_GT(largest, 0.5) << "the limit is of no concern";
}

constexpr const char* still = "[[stage]]\nname = \"still\"\nuntil = { steps = 4000 }\n";
constexpr const char* squeezed =
    "[[stage]]\nname = \"in\"\nstrain_rate = { x = 500, y = 500, z = 500 }\nuntil = { steps = 4000 }\n";
constexpr const char* sheared = "[[stage]]\nname = \"slide\"\nstrain_rate = { xz = 2000 }\nuntil = { steps = 4000 }\n";

INSTANTIATE_TEST_SUITE_P(Motions, ControllerIn,
                         ::testing::Values(Motion{"shaken", 0.3, 0.3, still}, Motion{"thrown", 5, 0, still},
                                           Motion{"spun", 0, 3, still}, Motion{"squeezed", 0.1, 0, squeezed},
                                           Motion{"slid", 0.1, 0, sheared}),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace eg
