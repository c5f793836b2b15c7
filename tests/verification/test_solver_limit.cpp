// The step at which the solver itself blows up, against the interval computed from the matrices.
#include <gtest/gtest.h>

#include "assembly/linearise.hpp"
#include "support/packings.hpp"
#include "timestep/damped_interval.hpp"
#include "timestep/solver_limit.hpp"

namespace eg {
namespace {

struct Case {
  std::string name;
  DampingSpec damping;
};

class SolverLimit : public ::testing::TestWithParam<Case> {
 protected:
  /// The solver's bracket holds the computed limit, to the tolerance of either. Growth just above the limit is slow and
  /// may go unseen: the solver is given `late` more.
  static void check(Scene scene, const State& state, double late) {
    scene.damping = GetParam().damping;
    const Network net = linearise(scene, state);
    const auto v = damped_interval(net, scene.damping, step_interval(net));
    SolverLimitOptions options;
    options.bracket.guess = v.dt_safe, options.bracket.tolerance = 1e-3;
    const auto found = solver_limit(scene, state, options);
    EXPECT_GE(found.unstable, v.dt_safe * (1 - 1e-6));
    EXPECT_LE(found.stable, v.dt_limit_upper * (1 + late));
  }
};

TEST_P(SolverLimit, OfALattice) {
  const Scene scene = test::lattice_scene("hertz-mindlin", "fcc", {2, 2, 2}, 0.01);
  State state = test::state_of(scene);
  { Engine lists(scene, state); }
  check(scene, state, 0.01);
}

TEST_P(SolverLimit, OfARandomPacking) {
  const Scene scene = test::scene_of("hertz-mindlin");
  const State state = test::random_packing(scene, "uniform", 60, 3, 0.7, 4000);
  check(scene, state, 0.02);
}

DampingSpec damping(double local, double mass, double normal, double shear) {
  DampingSpec d;
  d.local = local, d.mass = mass, d.normal_ratio = normal, d.shear_ratio = shear;
  return d;
}

INSTANTIATE_TEST_SUITE_P(Damping, SolverLimit,
                         ::testing::Values(Case{"none", damping(0, 0, 0, 0)}, Case{"local", damping(0.7, 0, 0, 0)},
                                           Case{"mass", damping(0, 2e6, 0, 0)}, Case{"weak", damping(0, 0, 0.1, 0.1)},
                                           Case{"strong", damping(0, 0, 1, 1)}, Case{"normal", damping(0, 0, 0.5, 0)},
                                           Case{"all", damping(0.3, 1e6, 0.3, 0.2)}),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace eg
