// Elastic tensors of packings: lattices against closed forms, random packings against a dense relaxation and against
// the packing itself, strained step by step.
#include <gtest/gtest.h>
#include <omp.h>

#include <numbers>

#include "app/prepare.hpp"
#include "assembly/linearise.hpp"
#include "measure/stress.hpp"
#include "stiffness/backbone.hpp"
#include "stiffness/effective_medium.hpp"
#include "stiffness/probe.hpp"
#include "stiffness/relaxation.hpp"
#include "stiffness/symmetry_fit.hpp"
#include "support/dense_moduli.hpp"
#include "support/packings.hpp"
#include "support/tiling.hpp"

namespace eg {
namespace {

using Solver = RelaxationOptions::Solver;

struct Specimen {
  Scene scene;
  State state;
  Network network;
  explicit Specimen(const Scene& s) : Specimen(s, test::state_of(s)) {}
  Specimen(const Scene& s, State made) : scene(s), state(std::move(made)) {
    { const Engine lists(scene, state); }
    network = linearise(scene, state);
  }
  double volume() const { return state.cell.volume(); }
  ElasticTensor tensor(Solver solver = Solver::automatic) const {
    const auto moduli = relax(network, periodic_strains(scene.dimension), volume(), {solver});
    EXPECT_TRUE(moduli.converged);
    return {scene.dimension, moduli.total()};
  }
};

double relative(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) { return (a - b).norm() / b.norm(); }

// Closed forms of physics: branch length d, kn, kt of a contact.
struct Lattice {
  const char* name;
  double c11, c12, c44;
};
TEST(ElasticLattice, ClosedForms) {
  const double kn = 1e6, kt = 7e5, overlap = 1e-3, d = 2e-3 * (1 - overlap), r2 = std::sqrt(2.0), r3 = std::sqrt(3.0);
  for (const Lattice& l : {Lattice{"sc", kn / d, 0, kt / (2 * d)},
                           Lattice{"bcc", (kn + 2 * kt) / (r3 * d), (kn - kt) / (r3 * d), (kn + kt / 2) / (r3 * d)},
                           Lattice{"fcc", r2 * (kn + kt) / d, (kn - kt) / (r2 * d), (kn + kt) / (r2 * d)},
                           Lattice{"square", kn, 0, kt / 2},
                           Lattice{"hexagonal", r3 / 4 * (3 * kn + kt), r3 / 4 * (kn - kt), r3 / 4 * (kn + kt)}}) {
    SCOPED_TRACE(l.name);
    const Specimen s(test::lattice_scene("linear", l.name, {3, 3, 3}, overlap));
    for (const auto solver : {Solver::cholesky, Solver::conjugate_gradients}) {
      const auto t = s.tensor(solver);
      const int dim = s.scene.dimension;
      Eigen::MatrixXd exact = Eigen::MatrixXd::Zero(t.size(), t.size());
      exact.topLeftCorner(dim, dim).setConstant(l.c12);
      for (int a = 0; a < t.size(); ++a) exact(a, a) = a < dim ? l.c11 : l.c44;
      EXPECT_LE(relative(t.voigt, exact), 1e-9);
      EXPECT_GT(eigenmoduli(t)(0), 0);
    }
  }
}

TEST(ElasticLattice, HcpRelaxesAsTheDenseSolutionDoes) {
  const Specimen s(test::lattice_scene("linear", "hcp", {3, 2, 2}, 1e-3));
  const auto exact = test::dense_tensor(s.network, s.volume());
  for (const auto solver : {Solver::cholesky, Solver::conjugate_gradients})
    EXPECT_LE(relative(s.tensor(solver).voigt, exact), 1e-9);
  const auto loads = periodic_strains(3);
  EXPECT_GT(relative(relax(s.network, loads, s.volume()).affine, exact), 1e-4);  // hcp does relax
  const auto fit = transverse_fit({3, exact});
  EXPECT_LE(fit.misfit, 1e-9);
  EXPECT_NEAR(fit.axis.z, 1, 1e-9);
}

// Duffy and Mindlin (1957): X = [3G²p/(2(1−ν)²)]^(1/3), C11 = X(4−3ν)/(2−ν), C44 = C11/2, C12 = Xν/(2(2−ν)).
TEST(ElasticLattice, DuffyMindlin) {
  const double g = 29e9, nu = 0.12, rho = 2650 * std::numbers::pi / (3 * std::sqrt(2.0));
  for (const double p : {1e3, 1e4, 1e5, 1e6, 1e7}) {
    Scene scene = test::lattice_scene("hertz-mindlin", "fcc", {2, 2, 2}, 0);
    scene.specimen.pressure = p;
    const auto t = Specimen(scene).tensor();
    const double x = std::cbrt(3 * g * g * p / (2 * (1 - nu) * (1 - nu)));
    const double strain = std::pow(p / g, 2. / 3);  // the closed form is that of vanishing overlap
    EXPECT_NEAR(t.voigt(0, 0) / (x * (4 - 3 * nu) / (2 - nu)), 1, 1e-9 + 2 * strain) << p;
    EXPECT_NEAR(t.voigt(3, 3) / (x * (4 - 3 * nu) / (2 - nu) / 2), 1, 1e-9 + 2 * strain) << p;
    EXPECT_NEAR(t.voigt(0, 1) / (x * nu / (2 * (2 - nu))), 1, 1e-9 + 2 * strain) << p;
    if (p != 1e5) continue;
    const double r2 = std::sqrt(0.5), r3 = std::sqrt(1. / 3);
    const auto along = [&](const Vec3& n) { return wave_speeds(t, rho, n).speed; };
    EXPECT_NEAR(t.voigt(0, 0) / 1.0574281e9, 1, 1e-3);
    EXPECT_NEAR(t.voigt(0, 1) / 1.7430133e7, 1, 1e-3);
    EXPECT_NEAR(along({1, 0, 0})[0] / 734.08, 1, 1e-3);
    EXPECT_NEAR(along({1, 0, 0})[1] / 519.08, 1, 1e-3);
    EXPECT_NEAR(along({r2, r2, 0})[0] / 737.10, 1, 1e-3);
    EXPECT_NEAR(along({r2, r2, 0})[1] / 519.08, 1, 1e-3);
    EXPECT_NEAR(along({r2, r2, 0})[2] / 514.78, 1, 1e-3);
    EXPECT_NEAR(along({r3, r3, r3})[0] / 738.11, 1, 1e-3);
    EXPECT_NEAR(along({r3, r3, r3})[1] / 516.22, 1, 1e-3);
  }
}

class RandomPacking : public testing::TestWithParam<std::pair<const char*, int>> {
 protected:
  static Specimen make(std::size_t grains, int steps = 300) {
    Scene scene = test::scene_of(GetParam().first, GetParam().second);
    if (scene.contact.law == "linear") scene.materials = {test::linear_material(1e5, 7e4)};
    State state = test::random_packing(scene, "uniform", grains, 3, scene.dimension == 3 ? 0.66 : 0.86, steps);
    return {scene, std::move(state)};
  }
};

TEST_P(RandomPacking, AgreesWithADenseRelaxation) {
  const Specimen s = make(GetParam().second == 3 ? 100 : 200, 150);
  const auto exact = test::dense_tensor(s.network, s.volume());
  for (const auto solver : {Solver::cholesky, Solver::conjugate_gradients}) {
    const auto moduli = relax(s.network, periodic_strains(s.scene.dimension), s.volume(), {solver});
    EXPECT_LE(relative(moduli.total(), exact), 1e-8);
    EXPECT_LE(moduli.asymmetry, 1e-5);
    EXPECT_GE((moduli.total() - exact).trace(), -1e-12 * exact.trace());  // from above
    const ElasticTensor affine{s.scene.dimension, moduli.affine}, relaxed{s.scene.dimension, moduli.total()};
    EXPECT_GT(isotropic_fit(affine).bulk, isotropic_fit(relaxed).bulk);
    EXPECT_GT(isotropic_fit(affine).shear, isotropic_fit(relaxed).shear);
    EXPECT_GE(eigenmoduli({s.scene.dimension, moduli.affine - moduli.total()})(0), -1e-9 * moduli.affine.norm());
  }
}

TEST_P(RandomPacking, RattlersMakeNoDifference) {
  Specimen s = make(150, 150);
  const auto loads = periodic_strains(s.scene.dimension);
  const auto whole = relax(s.network, loads, s.volume());
  const auto bone = backbone(s.network);
  const auto bare = relax(bone.network, loads, s.volume());
  EXPECT_LE(relative(bare.total(), whole.total()), 1e-8);
  s.network.springs.push_back({0, 0, 0, 0, 0, 0, {1, 0, 0}, 0});  // springs of no stiffness do no harm either
  EXPECT_LE(relative(relax(s.network, loads, s.volume()).total(), whole.total()), 1e-8);
}

// A periodic packing repeated is the same material: 2×2×2 copies have the tensor of one.
TEST(Relaxation, CopiesSideBySideAreTheSameMaterial) {
  const Scene scene = test::scene_of("hertz-mindlin");
  const State one = test::random_packing(scene, "uniform", 200, 3, 0.66, 150);
  const Specimen small(scene, one), large(scene, test::tiled(scene, one, 2));
  ASSERT_EQ(large.network.springs.size(), 8 * small.network.springs.size());
  EXPECT_LE(relative(large.tensor(Solver::conjugate_gradients).voigt, small.tensor(Solver::cholesky).voigt), 1e-9);
}

TEST(Relaxation, IsTheSameForAnyNumberOfThreads) {
  Specimen s(test::lattice_scene("linear", "fcc", {11, 11, 11}, 1e-3));
  Random random(4);
  for (Spring& spring : s.network.springs) spring.normal *= random.uniform(), spring.tangential *= random.uniform();
  const auto loads = periodic_strains(3);
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const auto one = relax(s.network, loads, s.volume(), {Solver::conjugate_gradients, 1e-6});
  omp_set_num_threads(2);
  const auto two = relax(s.network, loads, s.volume(), {Solver::conjugate_gradients, 1e-6});
  omp_set_num_threads(threads);
  EXPECT_GT(relative(one.affine, one.total()), 0.05);
  EXPECT_EQ(one.total(), two.total());
}

INSTANTIATE_TEST_SUITE_P(All, RandomPacking,
                         testing::Values(std::pair("hertz-mindlin", 3), std::pair("linear", 3), std::pair("linear", 2)),
                         [](const auto& info) {
                           return std::string(info.param.first == std::string("linear") ? "linear" : "hertz") +
                                  std::to_string(info.param.second) + "d";
                         });

/// A case of cases/ with some grains only, its first `stages` run until the packing rests: probing sees it so.
Specimen prepared(const std::string& name, const char* count, std::size_t stages) {
  Scene scene = read_scene(EIGENGRAIN_SOURCE_DIR "/cases/" + name + ".toml", {std::string("specimen.count=") + count});
  scene.stages.resize(stages);
  scene.stages.back().until_unbalanced = 1e-5;
  State state = make_specimen(scene);
  run_quietly(scene, state);
  state.friction = {10};  // no contact at its limit: the elastic moduli are those of sticking ones
  return {scene, std::move(state)};
}

void expect_probed(const Specimen& s) {
  const auto moduli = relax(s.network, periodic_strains(s.scene.dimension), s.volume());
  const double lambda = splitting_bound(s.network, {.matrix_sweeps = 0}).value;
  const auto found = probe(s.scene, s.state, {1.6 / std::sqrt(lambda)});
  EXPECT_TRUE(found.found);
  EXPECT_LE(relative(found.voigt, moduli.total()), 5e-3);
  EXPECT_GT(relative(moduli.affine, moduli.total()), 0.1);
  for (std::size_t a = 0; a < found.linear.size(); ++a) {
    EXPECT_GE(found.linear[a], 10 * found.strain[a]);
    EXPECT_LT(found.linear[a], 1e-2);  // contacts open and slide in the end
  }
}
TEST(Probing, HertzianSpheres) { expect_probed(prepared("demo", "200", 2)); }
TEST(Probing, LinearSpheres) { expect_probed(prepared("stiffness_linear", "200", 2)); }
TEST(Probing, LinearDisks) { expect_probed(prepared("disks_periodic", "300", 1)); }

// Grains in a box: an array of cubic cells between rough plates is a bar of springs.
TEST(Platens, SimpleCubicBetweenPlates) {
  Scene scene = test::lattice_scene("linear", "sc", {3, 3, 3}, 0);
  scene.boundary.kind = BoundarySpec::Kind::box, scene.boundary.wall_material = "grain";
  scene.boundary.bodies = box_bodies(scene.dimension);
  Packing packing = make_packing(scene);
  scene.materials[0].friction = 0;  // or side walls carry a part
  const double press = 1e-3;        // of the radius, at every wall and contact
  const double edge = packing.box.x * (1 - press);
  for (auto& x : packing.position) x = x * (1 - press);
  packing.box = {edge, edge, edge};
  const Specimen s(scene, make_state(scene, packing));
  ASSERT_EQ(s.network.springs.size(), 3u * 3 * 3 * 2 + 6 * 9);
  const auto moduli = relax(backbone(s.network).network, platen_strains({edge, edge, edge}), edge * edge * edge);
  // Two grain contacts and two wall contacts (the same kn) in a row, nine rows in parallel.
  const double kn = 1e6, expected = 9 * (kn / 4) * edge / (edge * edge);
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) EXPECT_NEAR(moduli.total()(a, b) / expected, a == b ? 1 : 0, 1e-9);
  EXPECT_NEAR(moduli.tangential.norm() / expected, 0, 1e-9);
}

}  // namespace
}  // namespace eg
