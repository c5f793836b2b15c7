// Bloch waves: the branches that are known in closed form, invariances, and the unit cell that they belong to.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "assembly/linearise.hpp"
#include "assembly/stiffness.hpp"
#include "base/error.hpp"
#include "dynamics/engine.hpp"
#include "support/networks.hpp"
#include "support/scenes.hpp"
#include "waves/dispersion.hpp"
#include "waves/unit_cell.hpp"

namespace eg {
namespace {

constexpr double kn = 3e5, kt = 2e5;

/// A lattice of the specimen maker, linear springs, reduced to its unit cell.
UnitCell lattice_cell(const std::string& name, std::array<int, 3> cells, double tangential = kt) {
  Scene scene = test::lattice_scene("linear", name, cells, 1e-10);
  scene.materials = {test::linear_material(kn, tangential)};
  State state = test::state_of(scene);
  { Engine lists(scene, state); }
  std::vector<Vec3> position;
  for (const auto& q : state.grains.position) position.push_back(q.vec());
  return find_unit_cell(linearise(scene, state), position, state.cell.h);
}

/// Wavelength-scaled data of a unit cell of equal grains.
struct Constants {
  double m, inertia, radius, d;
};
Constants constants_of(const UnitCell& unit) {
  const auto& net = unit.network;
  return {1 / net.inverse_mass[0], 1 / net.inverse_inertia[0], net.springs[0].arm_i, net.springs[0].length};
}

/// Both ω² of a Hermitian pair with diagonal A/m, B/I and coupling C/√(mI), by its trace and determinant.
std::array<double, 2> pair(double a, double b, double c, const Constants& k) {
  const double trace = a / k.m + b / k.inertia, determinant = (a * b - c * c) / (k.m * k.inertia);
  const double upper = trace / 2 + std::sqrt(trace * trace / 4 - determinant);
  return {determinant / upper, upper};
}

/// ω of the unit cell at k beside those expected: equal to 1e-8 of themselves.
void expect_branches(const UnitCell& unit, const Vec3& k, std::vector<double> squares) {
  std::ranges::sort(squares);
  const auto modes = bloch_modes(unit.network, k);
  ASSERT_EQ(modes.size(), squares.size());
  for (std::size_t m = 0; m < modes.size(); ++m)
    EXPECT_NEAR(std::sqrt(modes[m].square), std::sqrt(squares[m]), 1e-8 * std::sqrt(squares[m])) << "branch " << m;
}

TEST(Dispersion, SimpleCubicAlongAnEdge) {
  const UnitCell unit = lattice_cell("sc", {3, 3, 3});
  ASSERT_EQ(unit.network.size(), 1u);
  const auto c = constants_of(unit);
  const double r = c.radius;
  for (const double theta : {0.05, 0.7, 1.9, std::numbers::pi}) {
    const auto p =
        pair(2 * kt * (1 - std::cos(theta)), kt * r * r * (6 + 2 * std::cos(theta)), 2 * kt * r * std::sin(theta), c);
    const double twist = 8 * kt * r * r / c.inertia;  // about the direction: only the contacts beside it resist
    expect_branches(unit, {0, 0, theta / c.d},
                    {4 * kn / c.m * std::pow(std::sin(theta / 2), 2), p[0], p[0], p[1], p[1], twist});
  }
}

TEST(Dispersion, SquareAlongAnEdge) {
  const UnitCell unit = lattice_cell("square", {4, 3, 1});
  ASSERT_EQ(unit.network.size(), 1u);
  const auto c = constants_of(unit);
  const double r = c.radius;
  for (const double theta : {0.05, 0.7, 1.9, std::numbers::pi}) {
    const auto p =
        pair(2 * kt * (1 - std::cos(theta)), kt * r * r * (6 + 2 * std::cos(theta)), 2 * kt * r * std::sin(theta), c);
    expect_branches(unit, {theta / c.d, 0, 0}, {4 * kn / c.m * std::pow(std::sin(theta / 2), 2), p[0], p[1]});
  }
}

TEST(Dispersion, FaceCentredCubicAlongAnEdge) {
  const UnitCell unit = lattice_cell("fcc", {2, 1, 3});
  ASSERT_EQ(unit.network.size(), 1u);
  EXPECT_EQ(unit.copies, 24u);
  EXPECT_EQ(unit.network.springs.size(), 6u);
  const auto c = constants_of(unit);
  const double r = c.radius;
  for (const double theta : {0.05, 0.7, 1.9, std::numbers::pi}) {
    const double longitudinal = 8 * (kn + kt) * std::pow(std::sin(theta / 2), 2) / c.m;
    const auto p = pair((2 * kn + 6 * kt) * (1 - std::cos(theta)), kt * r * r * (10 + 6 * std::cos(theta)),
                        4 * std::numbers::sqrt2 * kt * r * std::sin(theta), c);
    const double twist = kt * r * r * (12 + 4 * std::cos(theta)) / c.inertia;
    expect_branches(unit, {0, 0, theta * std::numbers::sqrt2 / c.d}, {longitudinal, p[0], p[0], p[1], p[1], twist});
  }
}

TEST(Dispersion, Chain) {
  const UnitCell unit = lattice_cell("sc", {2, 2, 5}, 0);
  const auto c = constants_of(unit);
  for (const double theta : {1e-2, 0.5, 2.0, std::numbers::pi}) {
    const auto modes = bloch_modes(unit.network, {0, 0, theta / c.d});
    const double w = 2 * std::sqrt(kn / c.m) * std::abs(std::sin(theta / 2));
    EXPECT_NEAR(std::sqrt(modes.back().square), w, 1e-8 * w);
    EXPECT_NEAR(modes.back().mean[2], 1, 1e-12);
  }
  EXPECT_NEAR(bloch_modes(unit.network, {0, 0, std::numbers::pi / c.d}).back().frequency(),
              std::sqrt(kn / c.m) / std::numbers::pi, 1e-6);
}

TEST(Dispersion, RotationAtTheOrigin) {
  for (const auto& [name, coordination] : {std::pair{"sc", 6}, {"bcc", 8}, {"fcc", 12}, {"hcp", 12}}) {
    const UnitCell unit = lattice_cell(name, {3, 3, 3});
    const auto c = constants_of(unit);
    const double square = 10.0 * coordination / 3 * kt / c.m;
    int found = 0;
    for (const auto& mode : bloch_modes(unit.network, {}))
      found += mode.rotation > 1 - 1e-9 && std::abs(mode.square / square - 1) < 1e-8;
    EXPECT_EQ(found, 3) << name;
  }
}

TEST(Dispersion, LongWavesOfFaceCentredCubic) {
  const UnitCell unit = lattice_cell("fcc", {2, 2, 2});
  const auto c = constants_of(unit);
  const auto speeds = long_wave_speeds(unit.network, {0, 0, 2}, c.d);
  const double longitudinal = std::sqrt((kn + kt) / c.m) * c.d;
  ASSERT_EQ(speeds.size(), 3u);
  EXPECT_NEAR(speeds[2], longitudinal, 1e-7 * longitudinal);
  EXPECT_NEAR(speeds[0], longitudinal / std::numbers::sqrt2, 1e-7 * longitudinal);
  EXPECT_NEAR(speeds[1], longitudinal / std::numbers::sqrt2, 1e-7 * longitudinal);
}

TEST(Dispersion, BlockHasTheModesOfItsUnitCell) {
  const auto block = test::lattice_network("bcc", 2, 1.0, 0.7, true);
  const auto points = test::lattice_points("bcc", 2);
  Mat3 edges;
  for (int k = 0; k < 3; ++k) edges(k, k) = points.box[k];
  const UnitCell unit = find_unit_cell(block, points.position, edges);
  ASSERT_EQ(unit.copies, 16u);
  ASSERT_EQ(unit.network.springs.size(), 4u);
  const Vec3 k{0.3, 0.8, -0.5};
  const auto whole = bloch_modes(block, k);
  for (const auto& mode : bloch_modes(unit.network, k))
    EXPECT_TRUE(std::ranges::any_of(whole, [&](const BlochMode& m) {
      return std::abs(m.square - mode.square) < 1e-12;
    })) << mode.square;
  std::array<double, 3> mean{};  // the unit cell's modes are those that move it as a whole
  for (const auto& m : whole)
    for (std::size_t axis = 0; axis < 3; ++axis) mean[axis] += m.mean[axis];
  for (const double sum : mean) EXPECT_NEAR(sum, 1, 1e-12);
}

TEST(Dispersion, RandomPackingIsItsOwnUnitCell) {
  std::vector<Vec3> at;
  const auto network = test::random_network({.grains = 30, .wall_share = 0}, 4, &at);
  const Mat3 edges = 100.0 * Mat3::identity();
  const UnitCell unit = find_unit_cell(network, at, edges);
  EXPECT_EQ(unit.copies, 1u);
  EXPECT_EQ(unit.network.springs.size(), network.springs.size());
  const auto modes = bloch_modes(unit.network, {});
  const Eigen::VectorXd dense =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(dense_scaled_stiffness(network)).eigenvalues();
  for (std::size_t m = 0; m < modes.size(); ++m)
    EXPECT_NEAR(modes[m].square, dense(static_cast<Eigen::Index>(m)), 1e-12 * dense.maxCoeff());
}

TEST(Dispersion, ScatteredLatticeHasNoSmallerCell) {
  Scene scene = test::lattice_scene("linear", "fcc", {2, 2, 2}, 0.02);
  scene.specimen.radius_scatter = 0.01;
  State state = test::state_of(scene);
  { Engine lists(scene, state); }
  std::vector<Vec3> position;
  for (const auto& q : state.grains.position) position.push_back(q.vec());
  EXPECT_EQ(find_unit_cell(linearise(scene, state), position, state.cell.h).copies, 1u);
}

TEST(Dispersion, HermitianAndEvenInTheWaveVector) {
  const auto network = test::random_network({.grains = 12, .wall_share = 0, .fixed_share = 0.2}, 9);
  const Vec3 k{0.4, -1.1, 0.7};
  const auto d = bloch_matrix(network, k);
  EXPECT_LE((d - d.adjoint()).cwiseAbs().maxCoeff(), 1e-14 * d.cwiseAbs().maxCoeff());
  const auto there = bloch_modes(network, k), back = bloch_modes(network, -k);
  for (std::size_t m = 0; m < there.size(); ++m)
    EXPECT_NEAR(there[m].square, back[m].square, 1e-11 * there.back().square);
}

TEST(Zone, PathsOfNamesAndNumbers) {
  const auto path = parse_zone_path("G X 0.5,-0.25,1e-1 L", "fcc", 3);
  ASSERT_EQ(path.size(), 4u);
  EXPECT_EQ(path[1].reduced.z, 1);
  EXPECT_EQ(path[2].reduced.y, -0.25);
  for (const char* wrong : {"G", "", "G Q", "G 0.5,0.5", "G 0.5,0.5,0,1", "G G", "G 0.5,x,0", "G 0.5;0.5;0"})
    EXPECT_THROW(parse_zone_path(wrong, "fcc", 3), InputError) << wrong;
  for (const char* lattice : {"sc", "bcc", "fcc", "hcp", ""})
    EXPECT_NO_THROW(parse_zone_path(usual_path(lattice, 3), lattice, 3));
  for (const char* lattice : {"square", "hexagonal", ""})
    EXPECT_NO_THROW(parse_zone_path(usual_path(lattice, 2), lattice, 2));
}

}  // namespace
}  // namespace eg
