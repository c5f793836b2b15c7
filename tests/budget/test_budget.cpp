// Instructions a contact and step, so that a change that makes the loops slower shows without a clock. Budgets are some
// ten per cent above what the code takes now (docs/performance.md); who makes it faster lowers them.
#include <gtest/gtest.h>
#include <omp.h>

#include "assembly/apply.hpp"
#include "assembly/linearise.hpp"
#include "budget/instructions.hpp"
#include "dynamics/engine.hpp"
#include "search/neighbours.hpp"
#include "support/scenes.hpp"

namespace eg {
namespace {

TEST(Budget, CountsInstructions) {
  const auto some = test::instructions_of([] { __asm__ volatile(".rept 1000\n\tnop\n\t.endr"); });
  EXPECT_GE(some, 1000u);
  EXPECT_LE(some, 1020u);
}

#if defined(__AVX512F__) && !defined(__clang__)  // what the budgets were measured with
struct Budget {
  double step, frictionless, partial_slip, product, refresh;  // instructions a contact
};

constexpr Budget budget{102, 67, 143, 43, 212};

/// 108 spheres, 648 contacts, all of which touch.
Scene scene_with(const std::string& law) { return test::lattice_scene(law, "fcc", {3, 3, 3}, 1e-3); }

double per_contact(std::uint64_t instructions, double contacts) { return static_cast<double>(instructions) / contacts; }

double step_of(const Scene& scene) {
  omp_set_num_threads(1);
  State state = test::state_of(scene);
  Random random(1);
  for (auto& v : state.grains.velocity) v.set(Vec3{random.normal(), random.normal(), random.normal()} * 1e-3);
  Engine engine(scene, state);
  engine.step(1e-8), engine.step(1e-8);
  const double contacts = engine.tally().touching;
  EXPECT_EQ(contacts, 648);
  return per_contact(test::instructions_of([&] { engine.step(1e-8, TallyLevel::none); }), contacts);
}

void expect_within(const char* what, double instructions, double allowed) {
  std::printf("%-16s %6.1f instructions a contact, budget %g\n", what, instructions, allowed);
  EXPECT_LE(instructions, allowed) << what;
  EXPECT_GE(instructions, 0.5 * allowed) << what << ": the budget is too loose to guard anything";
}

TEST(Budget, Step) { expect_within("step", step_of(scene_with("hertz-mindlin")), budget.step); }

TEST(Budget, StepWithoutFrictionAndRotation) {
  Scene scene = scene_with("hertz-mindlin");
  scene.materials.front().friction = 0;
  scene.rotation = false;
  expect_within("frictionless", step_of(scene), budget.frictionless);
}

TEST(Budget, StepWithPartialSlip) {
  expect_within("partial slip", step_of(scene_with("hertz-mindlin-deresiewicz")), budget.partial_slip);
}

TEST(Budget, StiffnessProduct) {
  omp_set_num_threads(1);
  const Scene scene = scene_with("hertz-mindlin");
  State state = test::state_of(scene);
  const Engine engine(scene, state);
  const Network network = linearise(scene, state);
  const StiffnessOperator k(network, StiffnessOperator::Scaling::mass);
  std::vector<double> x(k.rows(), 1.0), y(k.rows());
  k.apply(x, y);
  const auto count = test::instructions_of([&] { k.apply(x, y); });
  expect_within("K·x", per_contact(count, static_cast<double>(network.springs.size())), budget.product);
}

TEST(Budget, RefreshOfTheContacts) {
  omp_set_num_threads(1);
  const Scene scene = scene_with("hertz-mindlin");
  State state = test::state_of(scene);
  const Engine engine(scene, state);
  ListScratch scratch;
  refresh_contacts(state, scratch), refresh_contacts(state, scratch);
  const auto count = test::instructions_of([&] { refresh_contacts(state, scratch); });
  expect_within("refresh", per_contact(count, static_cast<double>(state.contacts.size())), budget.refresh);
}
#endif

}  // namespace
}  // namespace eg
