// 2,000 grains: the tensor against dense Cholesky and against straining the packing; theories of the mean field above.
#include <gtest/gtest.h>

#include "app/prepare.hpp"
#include "assembly/linearise.hpp"
#include "stiffness/backbone.hpp"
#include "stiffness/probe.hpp"
#include "stiffness/relaxation.hpp"
#include "stiffness/symmetry_fit.hpp"
#include "support/dense_moduli.hpp"
#include "timestep/splitting.hpp"

namespace eg {
namespace {

double relative(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) { return (a - b).norm() / b.norm(); }

class TwoThousandGrains : public testing::TestWithParam<const char*> {};

TEST_P(TwoThousandGrains, MatrixDenseAndProbedModuliAgree) {
  Scene scene = read_scene(EIGENGRAIN_SOURCE_DIR "/cases/" + std::string(GetParam()) + ".toml",
                           {std::string("specimen.count=2000")});
  scene.stages.resize(2);
  scene.stages.back().until_unbalanced = 1e-5;
  State state = make_specimen(scene);
  run_quietly(scene, state);
  state.friction = {10};  // no contact at its limit: the elastic moduli are those of sticking ones
  const Network network = linearise(scene, state);
  const double volume = state.cell.volume();
  ASSERT_EQ(network.size(), 2000u);
  const Eigen::MatrixXd exact = test::dense_tensor_by_cholesky(network, volume);
  const auto bone = backbone(network).network;
  for (const auto solver : {RelaxationOptions::Solver::cholesky, RelaxationOptions::Solver::conjugate_gradients}) {
    const auto moduli = relax(bone, periodic_strains(3), volume, {solver});
    EXPECT_LE(relative(moduli.total(), exact), 1e-8) << moduli.method;
    EXPECT_GT(isotropic_fit({3, moduli.affine}).bulk, isotropic_fit({3, exact}).bulk);
    EXPECT_GT(isotropic_fit({3, moduli.affine}).shear, isotropic_fit({3, exact}).shear);
  }
  const double lambda = splitting_bound(network, {.matrix_sweeps = 0}).value;
  const auto found = probe(scene, state, {1.6 / std::sqrt(lambda)});
  EXPECT_TRUE(found.found);
  EXPECT_LE(relative(found.voigt, exact), 5e-3);
  RecordProperty("probed_against_dense", std::to_string(relative(found.voigt, exact)));
}

INSTANTIATE_TEST_SUITE_P(Laws, TwoThousandGrains, testing::Values("demo", "stiffness_linear"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace eg
