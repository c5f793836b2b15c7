// K: symmetric, blind to rigid motion, the same as a sparse matrix, a dense one and an operator.
#include <gtest/gtest.h>
#include <omp.h>

#include "../support/networks.hpp"
#include "assembly/apply.hpp"
#include "assembly/stiffness.hpp"
#include "eigen/dense.hpp"
#include "eigen/vectors.hpp"

namespace eg {
namespace {

using test::random_network;

/// Displacements of a rigid motion u = v + ω × x, θ = ω.
Eigen::VectorXd rigid_motion(const Network& network, const std::vector<Vec3>& at, const Vec3& v, const Vec3& spin) {
  Eigen::VectorXd u(static_cast<Eigen::Index>(total_dofs(network)));
  Eigen::Index k = 0;
  for (std::size_t g = 0; g < network.size(); ++g) {
    const Vec3 move = v + cross(spin, at[g]);
    for (const int c : active_components(network)) u(k++) = c < 3 ? move[c] : spin[c - 3];
  }
  return u;
}

struct Case {
  int dimension;
  bool rotation;
};
class Stiffness : public testing::TestWithParam<Case> {};

TEST_P(Stiffness, IsSymmetricAndBlindToRigidMotion) {
  const auto [dimension, rotation] = GetParam();
  std::vector<Vec3> at;
  const auto network = random_network({dimension, rotation, 40, 4, -1, 0}, 3, &at);
  const auto k = stiffness_matrix(network);
  const double size = k.coeffs().abs().maxCoeff();
  EXPECT_LE((Eigen::MatrixXd(k) - Eigen::MatrixXd(k).transpose()).cwiseAbs().maxCoeff(), 1e-15 * size);
  const Vec3 move{.3, -.7, dimension == 3 ? 1.1 : 0.0};
  EXPECT_LE((k * rigid_motion(network, at, move, {})).cwiseAbs().maxCoeff(), 1e-13 * size);
  if (!rotation) return;
  const Vec3 spin{dimension == 3 ? .4 : 0.0, dimension == 3 ? -.2 : 0.0, .9};
  EXPECT_LE((k * rigid_motion(network, at, {}, spin)).cwiseAbs().maxCoeff(), 1e-12 * size);
}

TEST_P(Stiffness, OperatorSparseAndDenseAgree) {
  const auto [dimension, rotation] = GetParam();
  const auto network = random_network({dimension, rotation, 60, 4, -1, .3, .1}, 5);
  const auto n = static_cast<Eigen::Index>(total_dofs(network));
  const auto k = stiffness_matrix(network);
  const auto start = random_unit_vector(total_dofs(network), 1);
  std::vector<double> y(start.size());
  const auto x = Eigen::Map<const Eigen::VectorXd>(start.data(), n);
  StiffnessOperator(network, StiffnessOperator::Scaling::none).apply(start, y);
  const double size = k.coeffs().abs().maxCoeff();
  EXPECT_LE((Eigen::Map<Eigen::VectorXd>(y.data(), n) - k * x).cwiseAbs().maxCoeff(), 1e-14 * size);

  const auto dense = dense_scaled_stiffness(network);
  StiffnessOperator(network, StiffnessOperator::Scaling::mass).apply(start, y);
  EXPECT_LE((Eigen::Map<Eigen::VectorXd>(y.data(), n) - dense * x).cwiseAbs().maxCoeff(),
            1e-14 * dense.cwiseAbs().maxCoeff());
}

INSTANTIATE_TEST_SUITE_P(AllKinds, Stiffness,
                         testing::Values(Case{3, true}, Case{3, false}, Case{2, true}, Case{2, false}));

TEST(Stiffness, RefillKeepsThePattern) {
  auto network = random_network({}, 7);
  auto k = stiffness_matrix(network);
  const auto entries = k.nonZeros();
  for (auto& spring : network.springs) spring.normal *= 2, spring.tangential *= 3;
  refill_stiffness(network, k);
  EXPECT_EQ(k.nonZeros(), entries);
  EXPECT_EQ((Eigen::MatrixXd(k) - Eigen::MatrixXd(stiffness_matrix(network))).cwiseAbs().maxCoeff(), 0);
}

TEST(Stiffness, TwoSpheresByHand) {
  Network network;
  network.inverse_mass = {1 / 2., 1 / 3.};
  network.inverse_inertia = {1 / 5., 1 / 7.};
  network.radius = {1, 2};
  network.springs = {{0, 1, .9, 1.8, 10, 4, {1, 0, 0}}};
  const Eigen::MatrixXd k(stiffness_matrix(network));
  EXPECT_DOUBLE_EQ(k(0, 0), 10);
  EXPECT_DOUBLE_EQ(k(0, 6), -10);
  EXPECT_DOUBLE_EQ(k(1, 1), 4);
  EXPECT_DOUBLE_EQ(k(3, 3), 0);  // no twist
  EXPECT_DOUBLE_EQ(k(5, 5), 4 * .9 * .9);
  EXPECT_DOUBLE_EQ(k(5, 11), 4 * .9 * 1.8);  // both turning the same way slide against each other
  EXPECT_DOUBLE_EQ(k(1, 5), 4 * .9);         // up and turning counterclockwise add at the contact of i
  EXPECT_DOUBLE_EQ(k(7, 5), -4 * .9);
  const auto m = inverse_mass_diagonal(network);
  EXPECT_DOUBLE_EQ(m[2], 1 / 2.);
  EXPECT_DOUBLE_EQ(m[11], 1 / 7.);
}

TEST(Stiffness, ImageOfItselfFeelsOnlyRotation) {
  Network network;
  network.inverse_mass = {1};
  network.inverse_inertia = {1};
  network.radius = {1};
  network.springs = {{0, 0, 1, 1, 5, 2, {0, 0, 1}}};
  const Eigen::MatrixXd k(stiffness_matrix(network));
  EXPECT_DOUBLE_EQ(k.topLeftCorner(3, 3).norm(), 0);
  EXPECT_DOUBLE_EQ(k(3, 3), 2 * 4);
  EXPECT_DOUBLE_EQ(k(5, 5), 0);
  const StiffnessOperator a(network, StiffnessOperator::Scaling::mass);
  EXPECT_LE((dense_matrix(a) - k).norm(), 1e-14);
}

TEST(StiffnessOperator, SameBitsForAnyNumberOfThreads) {
  const auto network = test::lattice_network("fcc", 9, 1, .7, true);  // 2916 grains: three chunks
  const StiffnessOperator a(network, StiffnessOperator::Scaling::mass);
  const auto x = random_unit_vector(a.rows(), 2);
  std::vector<double> one(x.size()), many(x.size());
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  a.apply(x, one);
  for (const int t : {2, 3}) {
    omp_set_num_threads(t);
    a.apply(x, many);
    EXPECT_EQ(one, many) << t;
  }
  omp_set_num_threads(threads);
}

TEST(StiffnessOperator, GrainsNumberedInAnyOrder) {
  auto network = test::lattice_network("sc", 13, 1, .7, true);  // 2197 grains: three chunks
  Random random(5);
  for (auto& s : network.springs) {
    s.n = s.n * (1 / norm(s.n)), s.arm_i = random.uniform(.4, .6), s.arm_j = 1 - s.arm_i;
    if (random.uniform() < .5) std::swap(s.i, s.j), std::swap(s.arm_i, s.arm_j), s.n = -s.n;
  }
  const StiffnessOperator a(network, StiffnessOperator::Scaling::none);
  const Eigen::SparseMatrix<double> k = stiffness_matrix(network);
  const auto x = random_unit_vector(a.rows(), 3);
  std::vector<double> y(x.size());
  a.apply(x, y);
  const Eigen::VectorXd expected = k * Eigen::Map<const Eigen::VectorXd>(x.data(), k.cols());
  EXPECT_LE((Eigen::Map<const Eigen::VectorXd>(y.data(), k.rows()) - expected).norm(), 1e-13 * expected.norm());
}

}  // namespace
}  // namespace eg
