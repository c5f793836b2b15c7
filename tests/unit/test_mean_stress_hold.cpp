// A held mean stress has one integral: axes that answer together must not each pull at it.
#include <gtest/gtest.h>

#include "boundary/cell_control.hpp"

namespace eg {
namespace {

TEST(MeanStressHold, AnIntegralGrowsByTheErrorOfTheMeanAlone) {
  State state;
  state.cell.periodic = {true, true, true};
  state.grains.velocity = {{0, 0, 0, 1}};
  state.stiffness_sum = 9;
  state.virial(0, 0) = 0.5, state.virial(1, 1) = 0.7, state.virial(2, 2) = 1.8;  // a cell of volume 1: mean stress 1
  StageSpec stage;
  stage.control[2].value = 0.1;
  for (const std::size_t k : {0, 1}) {
    stage.control[k] = {ComponentControl::Kind::stress, 1.0};
    stage.mean_axes[k] = true;
  }
  stage.mean_stress = 1.0;
  control_cell(state, stage, 1e-3);
  for (const double integral : state.servo) EXPECT_EQ(integral, 0);
  EXPECT_EQ(state.cell.rate(0, 0), 0);
  stage.mean_stress = 1.5;
  control_cell(state, stage, 1e-3);
  EXPECT_GT(state.servo[0], 0);
  EXPECT_EQ(state.servo[1], 0);
  EXPECT_LT(state.cell.rate(0, 0), 0);
  EXPECT_EQ(state.cell.rate(0, 0), state.cell.rate(1, 1));
  EXPECT_EQ(state.cell.rate(2, 2), -0.1);
}

}  // namespace
}  // namespace eg
