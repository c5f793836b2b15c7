// K of the assembler against the forces of the solver.
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "assembly/linearise.hpp"
#include "assembly/stiffness.hpp"
#include "contact/laws.hpp"
#include "dynamics/engine.hpp"
#include "support/scenes.hpp"

using namespace eg;

namespace {

/// Forces and moments of all grains, six a grain, after the motion q (six a grain) from `state`.
Eigen::VectorXd forces_after(const Scene& scene, State state, const Eigen::VectorXd& q, bool scalar) {
  const double dt = 1e-6;
  for (std::size_t i = 0; i < state.grains.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(6 * i);
    const Vec3 u{q[k], q[k + 1], q[k + 2]}, theta{q[k + 3], q[k + 4], q[k + 5]};
    state.grains.position[i].set(state.grains.position[i].vec() + u);
    state.grains.velocity[i].set(u * (1 / dt));
    if (state.grains.rotates()) state.grains.spin[i].set(theta * (1 / dt));
  }
  Engine engine(scene, state, scalar);
  engine.forces(dt, TallyLevel::none);
  Eigen::VectorXd f(static_cast<Eigen::Index>(6 * state.grains.size()));
  for (std::size_t i = 0; i < state.grains.size(); ++i) {
    const ForceRow row = gather_row(engine.workspace(), i);
    const auto k = static_cast<Eigen::Index>(6 * i);
    f.segment<3>(k) << row.force.x, row.force.y, row.force.z;
    f.segment<3>(k + 3) << row.moment.x, row.moment.y, row.moment.z;
  }
  return f;
}

Eigen::MatrixXd dense(const std::vector<TangentBlock>& blocks, std::size_t grains) {
  Eigen::MatrixXd k =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(6 * grains), static_cast<Eigen::Index>(6 * grains));
  for (const auto& b : blocks)
    for (std::size_t r = 0; r < 12; ++r)
      for (std::size_t c = 0; c < 12; ++c) {
        const Index gr = r < 6 ? b.i : b.j, gc = c < 6 ? b.i : b.j;
        if (gr != no_index && gc != no_index)
          k(static_cast<Eigen::Index>(6 * gr + r % 6), static_cast<Eigen::Index>(6 * gc + c % 6)) += b.k[12 * r + c];
      }
  return k;
}

/// A loaded cluster: random overlaps, and shear forces at `mobilised` times their limit.
State loaded(const Scene& scene, double mobilised, std::uint64_t seed) {
  State state = test::cluster(scene, 12, seed);
  if (seed % 2 == 0)  // with a wall through it
    test::add_plane(state, {0.3e-3, 0, 0}, {1, 0, 0});
  { Engine engine(scene, state); }
  Random random(seed);
  const auto shear = [&](const ContactPoint& p) {
    Vec3 t = cross(p.geometry.n, Vec3{random.normal(), random.normal(), scene.dimension == 3 ? random.normal() : 0.0});
    if (scene.dimension == 2) t = Vec3{-p.geometry.n.y, p.geometry.n.x, 0};
    return t * (mobilised * p.limit / norm(t));
  };
  std::vector<std::pair<ContactPoint, Vec3>> set;
  visit_contacts(scene, state, [&](const ContactPoint& p) { set.emplace_back(p, shear(p)); });
  for (const auto& [p, t] : set)
    for (int k = 0; k < 3; ++k) {
      const auto h = static_cast<std::size_t>(k);
      if (p.j == no_index)
        state.wall_contacts[p.entry].history[h] = t[k];
      else
        state.contacts.history_at(p.entry, h) = t[k];
    }
  const std::size_t scalar = 3 * state.contacts.history_vectors;
  if (scene.contact.law == "hertz-mindlin-rescale" || scene.contact.law.ends_with("deresiewicz"))
    for (const auto& [p, t] : set) {  // a kink between loading and unloading: stand on the unloading side
      if (p.j == no_index)
        state.wall_contacts[p.entry].history[scalar] *= 2;
      else
        state.contacts.history_at(p.entry, scalar) *= 2;
    }
  return state;
}

struct Case {
  std::string law;
  double mobilised;
  int dimension;
};

class Tangent : public ::testing::TestWithParam<Case> {};

TEST_P(Tangent, ConsistentModeIsTheDerivativeOfTheForces) {
  const auto [law, mobilised, dimension] = GetParam();
  const Scene scene = test::scene_of(law, dimension);
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const State state = loaded(scene, mobilised, seed);
    const std::size_t n = 6 * state.grains.size();
    const Eigen::MatrixXd k = dense(consistent_blocks(scene, state), state.grains.size());
    const double scale_u = 1e-3;  // rotations count at the radius
    double worst = 0, largest = 0;
    for (std::size_t c = 0; c < n; ++c) {
      const bool turn = c % 6 >= 3;
      if (dimension == 2 && (c % 6 == 2 || c % 6 == 3 || c % 6 == 4)) continue;
      // A sliding contact that moves backwards sticks: probe on the side where the state stays sliding, i.e. both
      // one-sided differences agree only when it does. Small steps keep the second-order part below the tolerance.
      const double h = (turn ? 1e-9 / scale_u : 1e-9) * 1e-2;
      Eigen::VectorXd q = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(n));
      q[static_cast<Eigen::Index>(c)] = h;
      const Eigen::VectorXd up = forces_after(scene, state, q, true), down = forces_after(scene, state, -q, true);
      const Eigen::VectorXd column = (down - up) / (2 * h);
      for (std::size_t r = 0; r < n; ++r) {
        const double unit = (r % 6 >= 3 ? 1 / scale_u : 1.0) * (turn ? 1 / scale_u : 1.0);
        const auto rr = static_cast<Eigen::Index>(r), cc = static_cast<Eigen::Index>(c);
        worst = std::max(worst, std::abs(column[rr] - k(rr, cc)) * unit);
        largest = std::max(largest, std::abs(k(rr, cc)) * unit);
      }
    }
    EXPECT_LT(worst, 1e-6 * largest) << law << " mobilised " << mobilised << " seed " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Laws, Tangent, ::testing::ValuesIn([] {
                           std::vector<Case> cases;
                           for (const auto& law : law_names())
                             for (const double mobilised : {0.0, 0.5, 1.05})         // unloaded, sticking, sliding
                               if (mobilised == 0 || !law.ends_with("deresiewicz"))  // its kinks: test_contact_laws
                                 for (const int dimension : {2, 3}) cases.push_back({law, mobilised, dimension});
                           return cases;
                         }()),
                         [](const auto& info) {
                           std::string name = info.param.law + "_" +
                                              std::to_string(static_cast<int>(100 * info.param.mobilised)) + "_" +
                                              std::to_string(info.param.dimension) + "d";
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(Tangent, ElasticModeEqualsConsistentWithoutForces) {
  // At vanishing overlap and no shear the geometric terms vanish: both modes agree.
  const Scene scene = test::lattice_scene("linear", "fcc", {2, 2, 2}, 1e-9);
  State state = test::state_of(scene);
  { Engine engine(scene, state); }
  const Network net = linearise(scene, state);
  const Eigen::MatrixXd a = Eigen::MatrixXd(assemble_blocks(consistent_blocks(scene, state), net));
  const Eigen::MatrixXd b = Eigen::MatrixXd(stiffness_matrix(net));
  EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-7 * b.cwiseAbs().maxCoeff());
  EXPECT_EQ(net.springs.size(), 6 * net.size());
}

TEST(Tangent, RigidMotion) {
  const Scene scene = test::scene_of("hertz-mindlin");
  const State state = loaded(scene, 0.5, 7);
  const std::size_t n = state.grains.size();
  const Network net = linearise(scene, state);
  const Eigen::MatrixXd elastic = Eigen::MatrixXd(stiffness_matrix(net)),
                        consistent = dense(consistent_blocks(scene, state), n);
  Eigen::VectorXd shift = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(6 * n)), turn = shift, turned_force = shift;
  const Vec3 omega{0.3, -0.5, 0.8};
  for (std::size_t i = 0; i < n; ++i) {
    const auto k = static_cast<Eigen::Index>(6 * i);
    const Vec3 u = cross(omega, state.grains.position[i].vec());
    shift.segment<3>(k) << 0.2, 0.4, -0.7;
    turn.segment<6>(k) << u.x, u.y, u.z, omega.x, omega.y, omega.z;
  }
  visit_contacts(scene, state, [&](const ContactPoint& p) {
    const Vec3 f = cross(omega, p.force()), m = cross(omega, cross(p.geometry.n, p.shear));
    const auto i = static_cast<Eigen::Index>(6 * p.i), j = static_cast<Eigen::Index>(6 * p.j);
    turned_force.segment<6>(i) +=
        (Eigen::VectorXd(6) << -f.x, -f.y, -f.z, m.x * p.geometry.arm_i, m.y * p.geometry.arm_i, m.z * p.geometry.arm_i)
            .finished();
    turned_force.segment<6>(j) +=
        (Eigen::VectorXd(6) << f.x, f.y, f.z, m.x * p.geometry.arm_j, m.y * p.geometry.arm_j, m.z * p.geometry.arm_j)
            .finished();
  });
  const double scale = elastic.cwiseAbs().maxCoeff();
  EXPECT_LT((elastic * shift).cwiseAbs().maxCoeff(), 1e-12 * scale);
  EXPECT_LT((consistent * shift).cwiseAbs().maxCoeff(), 1e-12 * scale);
  EXPECT_LT((elastic * turn).cwiseAbs().maxCoeff(), 1e-14 * scale);
  EXPECT_LT((elastic - elastic.transpose()).cwiseAbs().maxCoeff(), 1e-12 * scale);
  const Eigen::VectorXd residual = consistent * turn + turned_force;  // K·rotation = −ω×F
  EXPECT_LT(residual.cwiseAbs().maxCoeff(), 1e-9 * turned_force.cwiseAbs().maxCoeff());
  EXPECT_GT(turned_force.cwiseAbs().maxCoeff(), 0);
}

}  // namespace
